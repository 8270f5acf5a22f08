// The snapshot behind Python's class Snapshot.
#pragma once

#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler::python {

struct PythonSnapshot {
  Patch patch;
  std::string scene;       ///< resolved, as TOML
  bool is_a_start = false; ///< its scene cannot reproduce it, and starts from the file that it is written to
};

} // namespace keeler::python
