#include "number_tables.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/report/html.hpp>
#include <keeler/scene/planet.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <vector>

namespace keeler::run_report {

namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string number(const quantities::Record& summary, const std::string& name, int digits = 3) {
  const std::optional<double> value = number_in(summary, name);
  return value ? format_number(*value, digits) : "not measured";
}

// Returns "12 s, 31 % of the time".
std::string cost(const quantities::Record& summary, const std::string& part) {
  const double wall = number_in(summary, "wall").value_or(0.0),
               seconds = number_in(summary, "split." + part).value_or(0.0);
  return wall > 0.0 ? fmt::format("{} s, {} % of the time", format_number(seconds, 3),
                                  format_number(100.0 * seconds / wall, 2))
                    : format_number(seconds, 3) + " s";
}

void add_gravity(Rows& rows, const Scene& scene, const quantities::Record& summary) {
  if (!scene.gravity)
    return;
  const double count = number_in(summary, "particle_count").value_or(0.0);
  rows.push_back({"self-gravity", advice::in_words(chosen_for(static_cast<std::size_t>(count), *scene.gravity)),
                  number_in(summary, "force_error.rms")
                      ? fmt::format("rms error of the forces {} of the rms force (worst of {} checks: {})",
                                    number(summary, "force_error.rms"), number(summary, "force_error.checks"),
                                    number(summary, "force_error.worst_rms"))
                      : "not measured",
                  cost(summary, "gravity")});
}

} // namespace

std::string derived_table(const Scene& scene, const Patch& patch) {
  assert(patch.size() > 0);
  const double wavelength = diagnostics::critical_wavelength(patch);
  const double density = diagnostics::material_density(patch);
  const auto text = [](double value) { return format_number(value, 4); };
  Rows rows = {{"derived", ""}};
  rows.push_back({"box", fmt::format("{} m × {} m = {} × {} λ_cr", text(patch.box.size_x), text(patch.box.size_y),
                                     text(patch.box.size_x / wavelength), text(patch.box.size_y / wavelength))});
  rows.push_back({"orbital frequency Ω", text(patch.orbital_frequency) + " rad/s"});
  rows.push_back({"κ/Ω, ν/Ω", text(patch.frequencies.kappa) + ", " + text(patch.frequencies.nu)});
  rows.push_back({"mean radius, density of the material",
                  fmt::format("{} m, {} kg/m³", text(diagnostics::mean_radius(patch)), text(density))});
  rows.push_back({"Hill parameter r_h", text(scene::hill_parameter(density, distance_from_saturn(scene.planet)))});
  if (!scene.time.automatic)
    rows.push_back({"step", text(scene.time.step) + " orbits"});
  if (scene.gravity)
    rows.push_back({"drifts per kick", fmt::format("{}", scene.gravity->kick_every)});
  return report::html_table(rows);
}

std::string measured_table(const quantities::Record& numbers, std::optional<quantities::UnitSystem> system) {
  Rows rows = table_of(numbers, system);
  rows.insert(rows.begin(), {"quantity", "value"});
  return report::html_table(rows);
}

std::string all_numbers(const quantities::Record& numbers) {
  Rows rows = {{"name", "value"}};
  const nlohmann::ordered_json flat = json_of(numbers).flatten();
  for (const auto& [path, value] : flat.items())
    rows.push_back({path.substr(1), value.is_null() ? "unknown" : json_text(value)});
  return report::html_table(rows);
}

std::string accuracy_table(const Scene& scene, const quantities::Record& summary) {
  Rows rows = {{"part", "method", "accuracy", "cost"}};
  rows.push_back({"contacts", "finder " + scene.collisions.finder,
                  fmt::format("largest overlap {} of a radius sum; contacts slower than the speed from one kick "
                              "of the pair's own gravity: fraction {}; searches given up: {}",
                              number(summary, "largest_overlap"), number(summary, "unresolved_contacts_share"),
                              number(summary, "finder_gave_up")),
                  cost(summary, "drift")});
  add_gravity(rows, scene, summary);
  rows.push_back({"energy, step by step", "work of collisions and kicks summed",
                  fmt::format("residual (rounding): {} J, compared with {} J lost in collisions",
                              number(summary, "energy_j.residual"), number(summary, "energy_j.lost_in_collisions")),
                  cost(summary, "series")});
  if (number_in(summary, "energy_balance.ratio"))
    rows.push_back(
        {"energy, of the steady part", "viscosity from the loss over that of the stresses; 1 is exact",
         fmt::format("{} ± {}", number(summary, "energy_balance.ratio", 4), number(summary, "energy_balance.error", 2)),
         cost(summary, "stresses")});
  return report::html_table(rows);
}

std::string timing_table(const quantities::Record& summary) {
  Rows rows = {{"part", "wall time, s", "fraction"}};
  const double wall = number_in(summary, "wall").value_or(0.0);
  for (const quantities::Entry& entry : summary.entries)
    if (const double seconds = number_in(summary, entry.quantity.name).value_or(0.0);
        seconds > 0.0 && entry.quantity.name.starts_with("split.")) {
      std::string part = entry.quantity.name.substr(6);
      std::replace(part.begin(), part.end(), '_', ' ');
      rows.push_back(
          {part, format_number(seconds, 3), wall > 0.0 ? fmt::format("{:.1f} %", 100.0 * seconds / wall) : ""});
    }
  rows.push_back({"**all**", format_number(wall, 4), ""});
  return report::html_table(rows);
}

} // namespace keeler::run_report
