// Puts the seal on a reduced model of an older version: seal_model old.h5 new.h5
// The numbers stay as they are. That they are those of the training is for the caller to know.
#include <cstdio>
#include <exception>

#include "rom/fixed_domain/model.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: seal_model old.h5 new.h5\n");
    return 2;
  }
  try {
    undula::rom::save_model(undula::rom::load_model(argv[1]), argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
