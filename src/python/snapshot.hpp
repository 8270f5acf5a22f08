// A patch as Python holds it.
#pragma once

#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler::python {

struct PythonSnapshot {
  Patch patch;
  std::string scene;       ///< resolved, as TOML
  bool is_a_start = false; ///< no fresh start makes it: its scene starts from the file that it is written to
};

} // namespace keeler::python
