# keeler_folder(NAME [SOURCES file...] [SHOWS header...] [USES folder...] [SEES folder...] [LIBRARIES public-library...]
#   [PRIVATE_LIBRARIES library...])
#
# One static library a concept folder: target keeler_NAME, alias keeler::NAME. Its users see build-tree directories that
# hold nothing but links: to the folder's public headers, include/keeler/NAME, which are installed, and to the headers
# that it SHOWS other folders. Both are included as <keeler/NAME/file.hpp>. A folder that includes another one without
# naming it under USES does not compile; and USES may name only folders lower in KEELER_FOLDERS.
# A folder of the laboratory sees what any other user of the library sees, the public headers, and beyond these the headers
# of KEELER_TOOLS, which know nothing of rings, and of the folders that it names under SEES.
function(keeler_folder name)
  cmake_parse_arguments(ARG "" "" "SOURCES;SHOWS;USES;SEES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  list(FIND KEELER_FOLDERS ${name} own_rank)
  foreach(used IN LISTS ARG_USES)
    list(FIND KEELER_FOLDERS ${used} rank)
    if(rank LESS 0 OR NOT rank LESS own_rank)
      message(FATAL_ERROR "folder '${name}' may not use '${used}': it stands higher in KEELER_FOLDERS")
    endif()
  endforeach()
  if("${name}" STREQUAL "gravity" AND "collision" IN_LIST ARG_USES)
    message(FATAL_ERROR "gravity and collision never include each other")
  endif()

  set(public_view "${PROJECT_BINARY_DIR}/include-rule/${name}/public")
  set(shown_view "${PROJECT_BINARY_DIR}/include-rule/${name}/shown")
  file(REMOVE_RECURSE "${PROJECT_BINARY_DIR}/include-rule/${name}") # links of headers that are no longer shown
  file(GLOB_RECURSE public_headers CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/include/keeler/${name}"
    "${PROJECT_SOURCE_DIR}/include/keeler/${name}/*.hpp")
  link_headers("${PROJECT_SOURCE_DIR}/include/keeler/${name}" "${public_view}/keeler/${name}" ${public_headers})
  link_headers("${CMAKE_CURRENT_SOURCE_DIR}" "${shown_view}/keeler/${name}" ${ARG_SHOWS})

  # asked of each target that uses this one: does it see the headers that this folder shows?
  set(sees "$<OR:$<NOT:$<BOOL:$<TARGET_PROPERTY:KEELER_SEES>>>,$<IN_LIST:${name},$<TARGET_PROPERTY:KEELER_SEES>>>")

  add_library(keeler_${name} STATIC ${ARG_SOURCES})
  add_library(keeler::${name} ALIAS keeler_${name})
  set_target_properties(keeler_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(keeler_${name} PUBLIC cxx_std_20)
  target_include_directories(keeler_${name} PUBLIC
    "$<BUILD_INTERFACE:${public_view}>" "$<BUILD_INTERFACE:$<${sees}:${shown_view}>>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_include_directories(keeler_${name} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}") # its private headers
  target_link_libraries(keeler_${name} PRIVATE "$<BUILD_INTERFACE:keeler_flags>")
  foreach(used IN LISTS ARG_USES)
    target_link_libraries(keeler_${name} PUBLIC keeler_${used})
  endforeach()
  target_link_libraries(keeler_${name} PUBLIC ${ARG_LIBRARIES})
  foreach(library IN LISTS ARG_PRIVATE_LIBRARIES)
    target_link_libraries(keeler_${name} PRIVATE ${library})
  endforeach()
  if(name IN_LIST KEELER_LAB)
    set_property(TARGET keeler_${name} PROPERTY KEELER_SEES ${KEELER_TOOLS} ${KEELER_LAB} ${ARG_SEES})
  endif()
  if(name IN_LIST KEELER_COLD_FOLDERS)
    keeler_cold(keeler_${name})
  endif()
  set_property(TARGET keeler_${name} PROPERTY KEELER_HEADERS ${public_headers} ${ARG_SHOWS})
  if(NOT name IN_LIST KEELER_NOT_INSTALLED)
    set_property(GLOBAL APPEND PROPERTY KEELER_TARGETS keeler_${name})
  endif()
endfunction()

# link_headers(FROM TO HEADER...): links TO/HEADER to FROM/HEADER.
function(link_headers from to)
  file(MAKE_DIRECTORY "${to}")
  foreach(header IN LISTS ARGN)
    cmake_path(GET header PARENT_PATH subfolder)
    file(MAKE_DIRECTORY "${to}/${subfolder}")
    file(CREATE_LINK "${from}/${header}" "${to}/${header}" SYMBOLIC)
  endforeach()
endfunction()

# Compiles a target with fewer optimisations, in less time: nothing in it runs once a particle and step.
function(keeler_cold target)
  target_compile_options(${target} PRIVATE "$<$<CONFIG:Release>:-O1>")
endfunction()
