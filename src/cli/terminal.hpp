// Properties of terminals, and texts that depend on their width.
#pragma once

#include <cassert>
#include <cstdlib>
#include <string>

#include <sys/ioctl.h>
#include <unistd.h>

namespace keeler::cli {

/// Returns the columns of the terminal at a descriptor; 80 if they are unknown or it is not a terminal.
inline int terminal_width(int descriptor) {
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Returns a bar of `columns` characters, brackets included, filled to this fraction.
/// Precondition: 0 ≤ `fraction` ≤ 1 and `columns` ≥ 2.
inline std::string progress_bar(double fraction, int columns) {
  assert(0.0 <= fraction && fraction <= 1.0 && columns >= 2);
  const auto inside = static_cast<std::size_t>(columns - 2),
             filled = static_cast<std::size_t>(fraction * (columns - 2));
  return "[" + std::string(filled, '#') + std::string(inside - filled, '.') + "]";
}

} // namespace keeler::cli
