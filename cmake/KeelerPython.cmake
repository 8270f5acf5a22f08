# KEELER_PYTHON: whether the Python package is built; on where Python's headers, numpy and pybind11 are found.
# Debian's packages are for the system's Python: another one is taken when a virtual environment is active, or when
# -DPython_EXECUTABLE names it.
if(NOT Python_EXECUTABLE AND NOT DEFINED ENV{VIRTUAL_ENV} AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
find_package(pybind11 2.10 QUIET CONFIG)
if(Python_FOUND AND pybind11_FOUND)
  option(KEELER_PYTHON "build the Python package" ON)
elseif(NOT DEFINED KEELER_PYTHON)
  set(KEELER_PYTHON OFF) # not in the cache: what is installed later is found then
endif()
