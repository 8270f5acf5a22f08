// Messages to the user on standard error: progress, notices, errors. A message that cannot be written is lost and
// nothing else happens: no run ends because nobody reads its progress.
#pragma once

#include <keeler/core/format.hpp>

#include <cstdio>
#include <string>

namespace keeler {

inline void write_message(const std::string& text) {
  std::fputs(text.c_str(), stderr); // whether it could be written does not matter
}

/// One line that names the program.
inline void say(const std::string& line) {
  write_message("keeler: " + printable_line(line) + "\n");
}

} // namespace keeler
