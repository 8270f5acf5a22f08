# Install the headers, the libraries (src/cli installs the program) and a package that find_package(keeler) finds.
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
write_basic_package_version_file(keeler-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/keeler-config.cmake" "${PROJECT_BINARY_DIR}/keeler-config-version.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/KeelerPackages.cmake" DESTINATION "${KEELER_PACKAGE_DIR}" COMPONENT library)

# cpack in a build folder makes Debian packages of what is installed, one a component.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME keeler)
set(CPACK_PACKAGE_CONTACT "The Keeler developers <keeler@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME keeler)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core) # of pictures
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libkeeler-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
  "cmake, libcairo2-dev, libcli11-dev, libeigen3-dev, libfftw3-dev, libfmt-dev, libhdf5-dev, libtomlplusplus-dev, libxxhash-dev, nlohmann-json3-dev")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Simulates a self-gravitating patch of a planetary ring: the program")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Simulates a self-gravitating patch of a planetary ring: headers and libraries")
if(KEELER_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-keeler)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy, fonts-dejavu-core, keeler (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Simulates a self-gravitating patch of a planetary ring: the Python package")
endif()
include(CPack)
