# Every library that Keeler links, named once: the build finds them here, and so does the installed package.
# A header-only library that no installed target names (Random123) stands in KeelerDependencies.cmake instead.

# Arguments of find_package, one entry a package.
set(KEELER_CMAKE_PACKAGES
  "Eigen3 3.4 NO_MODULE"
  "HDF5 1.10 COMPONENTS C"
  "OpenMP COMPONENTS CXX"
  "fmt 9"
  "nlohmann_json 3.11"
  "tomlplusplus"
  "CLI11 2.1")

# Prefix and module of pkg-config, one entry a package; the target is PkgConfig::PREFIX.
set(KEELER_PKGCONFIG_MODULES
  "CAIRO cairo"
  "FFTW fftw3"
  "FFTWF fftw3f"
  "XXHASH libxxhash")
