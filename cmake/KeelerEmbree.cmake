# KEELER_EMBREE: whether rays are traced (keeler photometry, analyze --elevation, render --lit); on where Embree is found.
find_package(embree 3.13 QUIET CONFIG)
if(embree_FOUND)
  option(KEELER_EMBREE "trace rays, by Intel's Embree" ON)
elseif(NOT DEFINED KEELER_EMBREE)
  set(KEELER_EMBREE OFF) # not in the cache: what is installed later is found then
  message(STATUS "Embree 3 is not found: no light and no occultations (Debian: libembree-dev)")
endif()
