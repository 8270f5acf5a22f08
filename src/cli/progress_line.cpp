#include "progress_line.hpp"

#include "messages.hpp"
#include "terminal.hpp"

#include <keeler/core/format.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <unistd.h>

namespace keeler::cli {
namespace {

constexpr int longest_bar = 30, shortest_bar = 10;
constexpr double terminal_interval_s = 0.1, log_interval_s = 10.0;
constexpr double settling_s = 1.0; // before it the estimate of the time left is too uncertain

std::string clock(double seconds) {
  const long whole = std::lround(seconds);
  return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                       : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

// Returns the time left as a part of a line, or nothing while it is unknown.
ProgressLine::Parts time_left(double fraction, double elapsed_s, double remaining_s) {
  if (fraction < 1.0 && (fraction <= 0.0 || elapsed_s < settling_s))
    return {};
  return {clock(remaining_s) + " left"};
}

// Joins the parts of a line and drops the last ones that do not fit.
std::string line_of(const ProgressLine::Parts& parts, std::size_t columns) {
  std::string line;
  for (const std::string& part : parts) {
    const std::string longer = line.empty() ? part : line + "  " + part;
    if (!line.empty() && longer.size() > columns)
      break;
    line = longer;
  }
  return line.substr(0, columns);
}

} // namespace

ProgressLine::ProgressLine(const TalkOption& talk) : terminal_(isatty(STDERR_FILENO) == 1), talk_(talk) {}

ProgressLine::~ProgressLine() {
  if (open_)
    write_message("\n");
}

bool ProgressLine::due(double elapsed_s, bool last) {
  if (talk_.quiet || (elapsed_s < next_s_ && !last))
    return false;
  next_s_ = elapsed_s + (terminal_ ? terminal_interval_s : log_interval_s);
  return true;
}

// Prints a line. On a terminal it is shorter than the width, so that it can be redrawn in place; the bar shrinks first.
void ProgressLine::print(std::optional<double> fraction, const Parts& parts) {
  if (!terminal_) {
    write_message(line_of(parts, std::string::npos) + "\n");
    return;
  }
  const int columns = std::max(terminal_width(STDERR_FILENO) - 1, shortest_bar);
  std::string numbers = line_of(parts, static_cast<std::size_t>(columns));
  const int left = std::min(columns - static_cast<int>(numbers.size()) - 1, longest_bar);
  if (fraction && left >= shortest_bar)
    numbers = progress_bar(*fraction, left) + " " + numbers;
  write_message("\r" + numbers + "\033[K");
  open_ = true;
}

double ProgressLine::quiet_s() const {
  return terminal_ ? 0.5 : log_interval_s;
}

// Shows nothing for short starts.
void ProgressLine::show(const initial_conditions::StartProgress& p) {
  begin_phase("the start", 0.0);
  if (p.elapsed_s >= quiet_s() && due(p.elapsed_s, p.fraction == 1.0))
    print(p.fraction, {fmt::format("{:3.0f} % of the start", 100.0 * p.fraction), clock(p.remaining_s) + " left"});
  if (p.fraction == 1.0)
    next_s_ = 0.0; // the next phase counts its time from 0
}

void ProgressLine::show(const runs::RunProgress& p) {
  begin_phase("the steps", p.elapsed_s);
  if (!due(p.elapsed_s, p.step == p.end_step))
    return;
  const double done = static_cast<double>(p.step) / static_cast<double>(p.end_step);
  Parts parts = {fmt::format("{:.3f}/{} orbits", p.orbits, format_number(p.end_orbits)),
                 fmt::format("{:3.0f} %", 100.0 * done)};
  for (const std::string& left : time_left(done, p.elapsed_s, p.remaining_s))
    parts.push_back(left);
  parts.push_back(fmt::format("{:.0f} collisions/s", p.collisions_per_second));
  print(done, parts);
}

void ProgressLine::show(const Progress& p) {
  begin_phase(p.what, p.elapsed_s);
  if (!due(p.elapsed_s, p.fraction == 1.0))
    return;
  Parts parts = {fmt::format("{:3.0f} %", 100.0 * p.fraction)};
  for (const std::string& left : time_left(p.fraction, p.elapsed_s, p.remaining_s))
    parts.push_back(left);
  parts.push_back(p.what);
  print(p.fraction, parts);
}

void ProgressLine::show_if_long(const Progress& p) {
  if (p.elapsed_s >= quiet_s())
    show(p);
}

void ProgressLine::begin_phase(const std::string& phase, double elapsed_s) {
  if (talk_.verbose && phase != phase_)
    note(fmt::format("after {:.1f} s: {}", elapsed_s, phase));
  phase_ = phase;
}

void ProgressLine::note(const std::string& text) {
  if (talk_.quiet)
    return;
  if (open_)
    write_message("\n");
  open_ = false;
  say(text);
}

// Shows neither a bar nor a time left: the time at which wakes settle is unknown.
void ProgressLine::show(const initial_conditions::ClumpingProgress& p) {
  if (!due(p.elapsed_s, p.settled))
    return;
  Parts parts = {fmt::format("{:.3f} orbits", p.orbits), clock(p.elapsed_s),
                 fmt::format("contrast {:.3f}", p.contrast)};
  if (!p.settling) {
    parts.push_back(fmt::format("compared from orbit {:g} on", p.criterion.min_orbits()));
  } else if (p.settling->standing < p.criterion.min_standing) {
    parts.push_back("no wakes above the noise");
  } else {
    const auto change = [&](const initial_conditions::WindowMeans& means) {
      return fmt::format("{:.0f} % (settled at {:.0f} %)", 100.0 * means.change(), 100.0 * means.tolerance);
    };
    parts.push_back(fmt::format("viscosity changes by {}, wake lengths by {} and {}", change(p.settling->viscosity),
                                change(p.settling->wavelength), change(p.settling->radial_wavelength)));
  }
  print(std::nullopt, parts);
}

} // namespace keeler::cli
