#include "apps/output/version_text.hpp"

#include <hdf5.h>
#include <mpi.h>
#include <slepcsys.h>
#include <slepcversion.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "apps/apps.hpp"
#include "fom/output/provenance.hpp"
#include "geometry/mesh/cgal_version.hpp"

namespace undula::apps {

std::string version_text() {
  const auto number = [](auto... parts) {
    std::string text;
    ((text += (text.empty() ? "" : ".") + std::to_string(parts)), ...);
    return text;
  };
  const auto build = provenance(1);
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> mpi{};
  int length = 0;
  MPI_Get_library_version(mpi.data(), &length);
  std::string mpi_text(mpi.data(), static_cast<std::size_t>(length));
  mpi_text.resize(std::min(mpi_text.size(), mpi_text.find_first_of(",\n")));
  return "undula " + build.at("version") + "\ncommit " + build.at("commit") + "\nPETSc " +
         number(PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR) + "\nSLEPc " +
         number(SLEPC_VERSION_MAJOR, SLEPC_VERSION_MINOR, SLEPC_VERSION_SUBMINOR) + "\nMPI " + mpi_text +
         "\nCGAL " + geometry::cgal_version() + "\nEigen " +
         number(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) + "\nHDF5 " +
         number(major, minor, release);
}

} // namespace undula::apps
