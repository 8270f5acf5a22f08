// A patch as Python holds it.
#pragma once

#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler::python {

struct PythonSnapshot {
  Patch patch;
  std::string scene; ///< resolved, as TOML
};

} // namespace keeler::python
