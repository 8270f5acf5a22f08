#include "progress_line.hpp"

#include <fmt/format.h>

#include <cmath>

#include <unistd.h>

namespace keeler {
namespace {

constexpr int bar_width = 28;
constexpr double terminal_interval_s = 0.1, log_interval_s = 10.0;

std::string clock(double seconds) {
  const long whole = std::lround(seconds);
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

} // namespace

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (open_)
    fmt::print(stderr, "\n");
}

void ProgressLine::show(const RunProgress& p) {
  const bool last = p.step == p.end_step;
  if (p.elapsed_s < next_s_ && !last)
    return;
  next_s_ = p.elapsed_s + (terminal_ ? terminal_interval_s : log_interval_s);
  const double done = static_cast<double>(p.step) / static_cast<double>(p.end_step);
  const std::string numbers = fmt::format("{:.3f}/{:.3g} orbits  {:3.0f} %  {} left  {:.0f} collisions/s", p.orbits,
                                          p.end_orbits, 100.0 * done, clock(p.remaining_s), p.collisions_per_second);
  if (!terminal_) {
    fmt::print(stderr, "{}\n", numbers);
    return;
  }
  const int filled = static_cast<int>(done * bar_width);
  fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(filled, '#'), std::string(bar_width - filled, '.'), numbers);
  std::fflush(stderr);
  open_ = true;
}

} // namespace keeler
