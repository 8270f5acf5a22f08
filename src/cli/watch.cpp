// keeler watch: shows a run from another terminal.
#include "command.hpp"
#include "number_options.hpp"
#include "print.hpp"
#include "terminal.hpp"

#include <keeler/core/format.hpp>
#include <keeler/runs/patch_units.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/runs/stored_patches.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <span>
#include <string_view>
#include <thread>

namespace keeler::cli {
namespace {

namespace unit = quantities::unit;

constexpr std::size_t min_label_columns = 18, value_columns = 10;

// The units in which velocities and viscosities are shown.
struct ShownUnits {
  quantities::UnitSystem system;
  quantities::PatchUnits patch;
};

struct Line {
  const char* column; ///< of the series
  const char* label;
  quantities::Unit unit{}; ///< if it depends on the system of units; otherwise it is part of the label

  std::string full_label(const ShownUnits& units) const {
    return unit.text.empty() ? label
                             : fmt::format("{}, {}", label, quantities::ascii(unit_in(unit, units.system).text));
  }

  /// True for columns that accumulate since the start of the run; their rate per orbit is shown.
  bool counts() const {
    const auto& columns = runs::series_columns();
    const auto same = [&](const runs::SeriesColumn& known) { return std::string_view(known.name) == column; };
    return std::find_if(columns.begin(), columns.end(), same)->kind != runs::ColumnKind::value;
  }
};

constexpr Line lines[] = {
    {"dispersion_x_m_s", "c_x", unit::metres_per_second},
    {"dispersion_z_m_s", "c_z", unit::metres_per_second},
    {"scale_height_m", "height, m"},
    {"collisions", "collisions/orbit"},
    {"energy_lost_j", "loss, J/orbit"},
    {"translational_viscosity_m2_s", "nu trans.", unit::viscosity},
    {"gravitational_viscosity_m2_s", "nu grav.", unit::viscosity},
    {"spin_dispersion_omega", "spins, Omega"},
    {"step_orbits", "step, orbits"},
};

// Returns the finite values of a column, or its rates between rows if it accumulates.
std::vector<double> values_of(const io::SeriesTable& series, const Line& line) {
  const std::vector<double>& orbits = series.of("time_orbits");
  const std::vector<double>& column = series.of(line.column);
  std::vector<double> values;
  const bool counts = line.counts();
  for (std::size_t i = counts ? 1 : 0; i < column.size(); ++i) {
    const double value = counts ? (column[i] - column[i - 1]) / (orbits[i] - orbits[i - 1]) : column[i];
    if (std::isfinite(value))
      values.push_back(value);
  }
  return values;
}

// Returns a plot of one line: the means over equal parts of the run, scaled from the smallest to the largest.
std::string small_plot(std::span<const double> values, std::size_t columns) {
  static constexpr const char* heights[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  columns = std::min(columns, values.size());
  std::vector<double> means;
  for (std::size_t k = 0; k < columns; ++k) {
    const std::span<const double> part =
        values.subspan(k * values.size() / columns, (k + 1) * values.size() / columns - k * values.size() / columns);
    double sum = 0.0;
    for (const double value : part)
      sum += value;
    means.push_back(sum / static_cast<double>(part.size()));
  }
  if (means.empty())
    return "";
  const auto [smallest, largest] = std::minmax_element(means.begin(), means.end());
  const double range = *largest - *smallest;
  std::string plot;
  for (const double mean : means)
    plot += heights[range > 0.0 ? std::lround(7.0 * (mean - *smallest) / range) : 0];
  return plot;
}

std::string remaining(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{}:{:02}:{:02} left", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string state_and_time_left(const runs::RunView& view) {
  const std::optional<double> left = view.remaining_s(static_cast<double>(std::time(nullptr)));
  return left ? view.state() + ", " + remaining(*left) : view.state();
}

// Returns the text of the screen; no line is longer than `width`.
std::string text_of(const runs::RunView& view, const std::string& folder, int width, const ShownUnits& units) {
  const auto columns = static_cast<std::size_t>(width);
  std::vector<std::string> text = {
      folder, state_and_time_left(view),
      fmt::format("orbit {} of {}", format_number(view.orbits, 4), format_number(view.end_orbits, 4)),
      progress_bar(view.completed_fraction(), std::clamp(width, 10, 60))};
  for (const auto& [what, name] : {std::pair{"snapshot", view.snapshot}, std::pair{"checkpoint", view.checkpoint},
                                   std::pair{"picture", view.picture}})
    if (!name.empty())
      text.push_back(fmt::format("{:<11} {}", what, name));
  std::string all;
  for (const std::string& line : text)
    all += line.substr(0, columns) + "\n";
  std::size_t label_columns = min_label_columns;
  for (const Line& line : lines)
    label_columns = std::max(label_columns, line.full_label(units).size() + 1);
  for (const Line& line : lines)
    if (view.series.find(line.column) != nullptr) {
      const std::vector<double> values = values_of(view.series, line);
      if (values.empty())
        continue;
      const double value = values.back() / size_of_unit(line.unit, units.system, units.patch);
      const std::string numbers =
          fmt::format("{:<{}}{:>{}}  ", line.full_label(units), label_columns, format_number(value, 3), value_columns);
      all += numbers.substr(0, columns);
      if (numbers.size() < columns)
        all += small_plot(values, columns - numbers.size());
      all += "\n";
    }
  return all;
}

// Prints the state of the run: on a terminal every second, redrawn in place, until the run ends; otherwise once.
ExitCode watch(const std::string& folder, quantities::UnitSystem system) {
  ShownUnits units{system, {}};
  if (system != quantities::UnitSystem::si)
    units.patch = runs::units_of(runs::load_newest_patch(folder).patches.front());
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  for (;;) {
    const runs::RunView view = runs::view_run(folder);
    const std::string text = text_of(view, folder, terminal_width(STDOUT_FILENO), units);
    if (terminal)
      fmt::print("\033[H\033[J");
    print("{}", text);
    std::fflush(stdout);
    if (!terminal || !view.running)
      return ExitCode::done;
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

} // namespace

void add_watch(CLI::App& program, Action& action) {
  const auto folder = std::make_shared<std::string>();
  const auto units = std::make_shared<UnitsOption>();
  CLI::App& command = *program.add_subcommand("watch", "show a run from another terminal while it works");
  command.add_option("DIR", *folder, "the folder of the run")->required()->type_name("");
  units->add_to(command);
  examples_of(command, {"keeler watch wakes", "keeler watch wakes --units radius"});
  command.callback([folder, units, &action] {
    action = [folder, units] { return watch(*folder, units->system().value_or(quantities::UnitSystem::si)); };
  });
}

} // namespace keeler::cli
