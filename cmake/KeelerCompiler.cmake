# Flags shared by everything that Keeler compiles.
# -ffp-contract=off: a fused multiply-add that appears in one build and not in another would change the bits of a result.
# -fno-math-errno: sqrt becomes one instruction; nothing here reads errno after a mathematical function.
# -fno-semantic-interposition: position-independent code calls and inlines its own functions as other code does.
add_library(keeler_flags INTERFACE)
target_compile_options(keeler_flags INTERFACE
  -ffp-contract=off -fno-math-errno -fno-semantic-interposition
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # gcc 12 gives false alarms from the first two on plain std::string and std::vector code. The third is about classes of
  # headers; it takes sources that are compiled together for headers.
  target_compile_options(keeler_flags INTERFACE -Wno-restrict -Wno-array-bounds -Wno-subobject-linkage)
endif()

if(KEELER_SANITIZE)
  add_compile_options(-fsanitize=${KEELER_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${KEELER_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc's manual: sanitizers bring false alarms of this kind; the other builds keep it.
    target_compile_options(keeler_flags INTERFACE -Wno-maybe-uninitialized)
  else() # nothing becomes vectors there, which is no fault
    target_compile_options(keeler_flags INTERFACE -Wno-pass-failed)
    if(KEELER_SANITIZE MATCHES "undefined") # by a path from the build folder, so that ccache hits in any copy
      file(RELATIVE_PATH ignored "${PROJECT_BINARY_DIR}" "${CMAKE_CURRENT_LIST_DIR}/undefined_ignore.txt")
      add_compile_options("-fsanitize-ignorelist=${ignored}")
    endif()
  endif()
  # As a library, which the Python package and its interpreter can share.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND KEELER_SANITIZE MATCHES "^address")
    execute_process(COMMAND "${CMAKE_CXX_COMPILER}" -print-file-name=libclang_rt.asan-${CMAKE_SYSTEM_PROCESSOR}.so
      OUTPUT_VARIABLE KEELER_ADDRESS_RUNTIME OUTPUT_STRIP_TRAILING_WHITESPACE)
    cmake_path(GET KEELER_ADDRESS_RUNTIME PARENT_PATH runtime_folder)
    add_link_options(-shared-libasan "-Wl,-rpath,${runtime_folder}")
  endif()
endif()

# A working copy in another folder has the same objects: paths count from the copy's own, which no object names.
find_program(KEELER_CCACHE ccache)
if(KEELER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1
    "${KEELER_CCACHE}")
endif()
