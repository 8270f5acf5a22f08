# Install the public headers, the libraries up to `runs` (src/cli installs the program) and a package that find_package(keeler)
# finds; the manual and the examples.
include(CMakePackageConfigHelpers)
get_property(KEELER_TARGETS GLOBAL PROPERTY KEELER_TARGETS)
set(KEELER_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/keeler")

install(TARGETS ${KEELER_TARGETS} EXPORT keeler ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}/keeler"
  COMPONENT library)
install(DIRECTORY include/keeler DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT library)
install(EXPORT keeler NAMESPACE keeler:: FILE keeler-targets.cmake DESTINATION "${KEELER_PACKAGE_DIR}"
  COMPONENT library)
configure_package_config_file(cmake/keeler-config.cmake.in keeler-config.cmake
  INSTALL_DESTINATION "${KEELER_PACKAGE_DIR}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(keeler-config-version.cmake COMPATIBILITY SameMajorVersion)
install(FILES "${PROJECT_BINARY_DIR}/keeler-config.cmake" "${PROJECT_BINARY_DIR}/keeler-config-version.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/KeelerPackages.cmake" DESTINATION "${KEELER_PACKAGE_DIR}" COMPONENT library)

# The manual as it stands in the source tree: its pages link to each other and to the examples by relative paths.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}"
  COMPONENT program)
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program PATTERN Doxyfile EXCLUDE)
install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DATADIR}/keeler" COMPONENT program PATTERN __pycache__ EXCLUDE)
file(RELATIVE_PATH examples_seen_from_manual "${CMAKE_INSTALL_FULL_DOCDIR}" "${CMAKE_INSTALL_FULL_DATADIR}/keeler/examples")
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/manual")
file(CREATE_LINK "${examples_seen_from_manual}" "${PROJECT_BINARY_DIR}/manual/examples" SYMBOLIC)
install(FILES "${PROJECT_BINARY_DIR}/manual/examples" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)

# cpack makes Debian packages of what is installed, one a component (scripts/package).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME keeler)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_PACKAGE_CONTACT "The Keeler developers <keeler@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENTS_ALL program library)

# debian_package(COMPONENT NAME SECTION SUMMARY LINE...): the lines are what a package manager shows below the summary.
function(debian_package component name section summary)
  list(JOIN ARGN "\n" more)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${more}" PARENT_SCOPE)
  install(FILES cmake/debian/copyright DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}" COMPONENT ${component})
endfunction()

debian_package(program keeler science "simulates a self-gravitating patch of a planetary ring"
  "Hard spheres on epicycles collide on their curved paths and attract each"
  "other. No collision is missed, and the answer is the same, bit for bit,"
  "for any number of threads and after any restart. The package holds the"
  "program, the manual and example scenes.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core) # of pictures
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "ffmpeg, python3-keeler") # movies

debian_package(library libkeeler-dev libdevel "patches of planetary rings in C++: headers and libraries"
  "What the program keeler is made of, as a CMake package for programs of"
  "one's own.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
  "cmake, libeigen3-dev, libfftw3-dev, libfmt-dev, libhdf5-dev, libtomlplusplus-dev, libxxhash-dev, nlohmann-json3-dev, pkg-config")
if(KEELER_EMBREE)
  string(APPEND CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS ", libembree-dev")
endif()

if(KEELER_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  debian_package(python python3-keeler python "patches of planetary rings in Python"
    "Simulations, snapshots and runs of keeler, with their states as numpy"
    "arrays and the same bits as the program.")
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy, fonts-dejavu-core, keeler (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/cmake/debian/postinst" "${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
endif()
# A build with MPI makes this package alone: all others are of the build without.
if(KEELER_MPI)
  set(CPACK_COMPONENTS_ALL mpi)
  debian_package(mpi keeler-mpi science "simulates a patch of a planetary ring on several processes"
    "The program of keeler built with MPI: mpirun -n 4 keeler-mpi run shares"
    "a run among processes of one machine or many, with the same bits.")
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "keeler (= ${PROJECT_VERSION}), openmpi-bin")
endif()
include(CPack)
