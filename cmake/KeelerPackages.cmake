# Every library that Keeler links, named once: the build finds them here, and so does the installed package. First comes
# the target that folders link.
# A header-only library that no installed target names (Random123) stands in KeelerDependencies.cmake instead.

# Target and arguments of find_package, one entry a package.
set(KEELER_CMAKE_PACKAGES
  "Eigen3::Eigen Eigen3 3.4 NO_MODULE"
  "HDF5::HDF5 HDF5 1.10 COMPONENTS C"
  "OpenMP::OpenMP_CXX OpenMP COMPONENTS CXX"
  "fmt::fmt fmt 9"
  "nlohmann_json::nlohmann_json nlohmann_json 3.11"
  "tomlplusplus::tomlplusplus tomlplusplus"
  "CLI11::CLI11 CLI11 2.1"
  "MPI::MPI_C MPI COMPONENTS C" # with KEELER_MPI alone
  "embree embree 3.13 CONFIG") # with KEELER_EMBREE alone

# Target and module of pkg-config, one entry a package.
set(KEELER_PKGCONFIG_MODULES
  "PkgConfig::CAIRO cairo"
  "PkgConfig::FFTW fftw3"
  "PkgConfig::FFTWF fftw3f"
  "PkgConfig::XXHASH libxxhash")
