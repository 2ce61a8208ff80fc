#include "fom/problem/stepping.hpp"

namespace undula::fom {

const char* coupling_name(Coupling coupling) {
  switch (coupling) {
    case Coupling::fixed:
      return "fixed";
    case Coupling::mapped:
      return "mapped";
    case Coupling::explicit_:
      return "explicit";
    case Coupling::implicit:
      return "implicit";
  }
  return "";
}

} // namespace undula::fom
