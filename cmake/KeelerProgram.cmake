# HDF5 and the runtime of OpenMP are linked into programs, where their archives exist. Debian's shared HDF5 loads forty
# more libraries for files on servers, which nothing here reads: they took a third of a start (docs/dev/project.md).
# A runtime of OpenMP inside reads its settings after the program has set them (src/cli/waiting_threads.cpp); a shared
# one reads them first, and the program has to start itself again.
# Libraries, and the module for Python, which shares HDF5 with h5py's users, link the shared ones.

# keeler_archive_in_programs(TARGET NAME): programs link the archive beside the shared library NAME that TARGET names.
function(keeler_archive_in_programs target name)
  get_target_property(libraries ${target} INTERFACE_LINK_LIBRARIES)
  if(NOT libraries)
    return()
  endif()
  set(chosen "")
  foreach(library IN LISTS libraries)
    string(REGEX REPLACE "\\.so$" ".a" archive "${library}")
    if(library MATCHES "/${name}\\.so$" AND EXISTS "${archive}")
      set(library "$<IF:$<BOOL:$<TARGET_PROPERTY:KEELER_PROGRAM>>,${archive},${library}>")
      set(${name}_in_programs ON PARENT_SCOPE)
    endif()
    list(APPEND chosen "${library}")
  endforeach()
  set_property(TARGET ${target} PROPERTY INTERFACE_LINK_LIBRARIES "${chosen}")
endfunction()

keeler_archive_in_programs(HDF5::HDF5 libhdf5)
keeler_archive_in_programs(OpenMP::OpenMP_CXX libgomp)

# keeler_program(TARGET): an executable that links these archives, and no shared library that it does not need.
function(keeler_program target)
  set_property(TARGET ${target} PROPERTY KEELER_PROGRAM ON)
  if(NOT APPLE)
    target_link_options(${target} PRIVATE LINKER:--as-needed)
  endif()
endfunction()
