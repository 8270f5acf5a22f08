#include "number_tables.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/report/html.hpp>
#include <keeler/scene/planet.hpp>

#include <fmt/format.h>

#include <cassert>
#include <vector>

namespace keeler::run_report {

namespace {
using Rows = std::vector<std::vector<std::string>>;
}

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

} // namespace keeler::run_report
