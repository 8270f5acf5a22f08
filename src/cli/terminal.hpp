// What the terminal that a stream ends in can show.
#pragma once

#include <cstdlib>
#include <string>

#include <sys/ioctl.h>
#include <unistd.h>

namespace keeler {

/// Columns of the terminal behind a stream's descriptor; 80 where it does not say, or is none.
inline int terminal_width(int descriptor) {
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// A bar of so many columns, brackets included, that is full to this share (0 … 1).
inline std::string progress_bar(double share, int columns) {
  const auto inside = static_cast<std::size_t>(columns - 2), filled = static_cast<std::size_t>(share * (columns - 2));
  return "[" + std::string(filled, '#') + std::string(inside - filled, '.') + "]";
}

} // namespace keeler
