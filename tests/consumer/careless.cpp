// Warns of an unused variable, which is the business of this project and no error.
#include "rom/base/units.hpp"

int main() {
  int unused;
  return undula::units::length_from_mm(10.0) == 1.0 ? 0 : 1;
}
