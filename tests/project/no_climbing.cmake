# Fails when a source or header includes by a path that climbs ("../") or by an absolute one.
file(GLOB_RECURSE files "${SOURCE_DIR}/include/*.hpp" "${SOURCE_DIR}/src/*.hpp" "${SOURCE_DIR}/src/*.cpp"
  "${SOURCE_DIR}/lab/*.hpp" "${SOURCE_DIR}/lab/*.cpp"
  "${SOURCE_DIR}/tests/*.hpp" "${SOURCE_DIR}/tests/*.cpp")
if(NOT files)
  message(FATAL_ERROR "no sources under '${SOURCE_DIR}'")
endif()
foreach(file IN LISTS files)
  file(STRINGS "${file}" climbing REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"](/|.*\\.\\./)")
  foreach(line IN LISTS climbing)
    message(SEND_ERROR "${file}: ${line}: write <keeler/folder/file.hpp>")
  endforeach()
endforeach()
