#include "progress_line.hpp"

#include "messages.hpp"

#include <keeler/core/words.hpp>

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

std::string bar_of(double share) {
  const int filled = static_cast<int>(share * bar_width);
  return fmt::format("[{}{}] ", std::string(filled, '#'), std::string(bar_width - filled, '.'));
}

} // namespace

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (open_)
    write_message("\n");
}

bool ProgressLine::due(double elapsed_s, bool last) {
  if (elapsed_s < next_s_ && !last)
    return false;
  next_s_ = elapsed_s + (terminal_ ? terminal_interval_s : log_interval_s);
  return true;
}

void ProgressLine::print(const std::string& bar, const std::string& numbers) {
  if (!terminal_) {
    write_message(numbers + "\n");
    return;
  }
  write_message("\r" + bar + numbers + "\033[K");
  open_ = true;
}

// Most starts are made before anybody looks.
void ProgressLine::show(const StartProgress& p) {
  const double patience_s = terminal_ ? 0.5 : log_interval_s;
  if (p.elapsed_s >= patience_s && due(p.elapsed_s, p.share == 1.0))
    print(bar_of(p.share), fmt::format("{:3.0f} % of the start  {} left", 100.0 * p.share, clock(p.remaining_s)));
  if (p.share == 1.0)
    next_s_ = 0.0; // what follows has a clock of its own
}

void ProgressLine::show(const RunProgress& p) {
  if (!due(p.elapsed_s, p.step == p.end_step))
    return;
  const double done = static_cast<double>(p.step) / static_cast<double>(p.end_step);
  print(bar_of(done), fmt::format("{:.3f}/{} orbits  {:3.0f} %  {} left  {:.0f} collisions/s", p.orbits,
                                  figures(p.end_orbits), 100.0 * done, clock(p.remaining_s), p.collisions_per_second));
}

void ProgressLine::show(const Progress& p) {
  if (due(p.elapsed_s, p.share == 1.0))
    print(bar_of(p.share), fmt::format("{:3.0f} %  {} left  {}", 100.0 * p.share, clock(p.remaining_s), p.what));
}

void ProgressLine::note(const std::string& text) {
  if (open_)
    write_message("\n");
  open_ = false;
  say(text);
}

// No bar and no time left: nobody knows when wakes settle.
void ProgressLine::show(const ClumpingProgress& p) {
  if (!due(p.elapsed_s, p.settled))
    return;
  std::string numbers = fmt::format("{:.3f} orbits  {}  contrast {:.3f}", p.orbits, clock(p.elapsed_s), p.contrast);
  if (!p.settling) {
    numbers += fmt::format("  compared from orbit {:g} on", p.criterion.least_orbits());
  } else if (p.settling->standing < p.criterion.least_standing) {
    numbers += "  no wakes stand out";
  } else {
    const auto change = [&](const WindowMeans& means) {
      return fmt::format("{:.0f} % (settled at {:.0f} %)", 100.0 * means.change(), 100.0 * means.tolerance);
    };
    numbers += fmt::format("  viscosity changes by {}, wake lengths by {} and {}", change(p.settling->viscosity),
                           change(p.settling->wavelength), change(p.settling->radial_wavelength));
  }
  print("", numbers);
}

} // namespace keeler
