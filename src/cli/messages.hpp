// Messages to the user on standard error: progress, notices, errors. A message that cannot be written is dropped: a run
// does not end because its standard error is closed.
#pragma once

#include <keeler/core/format.hpp>

#include <cstdio>
#include <string>

namespace keeler::cli {

inline void write_message(const std::string& text) {
  std::fputs(text.c_str(), stderr); // failure is ignored
}

/// Writes one line that begins with the program's name.
inline void say(const std::string& line) {
  write_message("keeler: " + printable_line(line) + "\n");
}

} // namespace keeler::cli
