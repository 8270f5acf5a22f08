# Install the headers, the libraries (src/cli installs the program) and a package that find_package(keeler) finds.
include(CMakePackageConfigHelpers)
get_property(KEELER_TARGETS GLOBAL PROPERTY KEELER_TARGETS)
set(KEELER_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/keeler")

install(TARGETS ${KEELER_TARGETS} EXPORT keeler ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}/keeler")
install(DIRECTORY include/keeler DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(EXPORT keeler NAMESPACE keeler:: FILE keeler-targets.cmake DESTINATION "${KEELER_PACKAGE_DIR}")
configure_package_config_file(cmake/keeler-config.cmake.in keeler-config.cmake
  INSTALL_DESTINATION "${KEELER_PACKAGE_DIR}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(keeler-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/keeler-config.cmake" "${PROJECT_BINARY_DIR}/keeler-config-version.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/KeelerPackages.cmake" DESTINATION "${KEELER_PACKAGE_DIR}")
