#include "number_tables.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/core/words.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/report/html.hpp>
#include <keeler/scene/derived.hpp>

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <vector>

namespace keeler {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

// "0.0123", "unknown" for null.
std::string text_of(const Json& number) {
  return number.is_number() ? figures(number.get<double>(), 4) : "unknown";
}

std::string with_error(const Json& number, const Json& error) {
  return error.is_number() && number.is_number()
             ? fmt::format("{} ± {}", text_of(number), figures(error.get<double>(), 2))
             : text_of(number);
}

Json of(const Json& numbers, const std::string& key) {
  return numbers.value(key, Json());
}

std::string viscosities(const Json& numbers) {
  Rows rows = {{"viscosity", "m²/s", "r² Ω", "G² Σ²/Ω³"}};
  for (const auto& [key, name] :
       {std::pair{"translational", "translational (local)"}, std::pair{"collisional", "collisional (nonlocal)"},
        std::pair{"gravitational", "gravitational"}, std::pair{"total", "all three"},
        std::pair{"loss", "from the energy that collisions lose"}}) {
    const std::string start = fmt::format("{}_viscosity_", key);
    rows.push_back({name, with_error(of(numbers, start + "m2_s"), of(numbers, start + "error_m2_s")),
                    text_of(of(numbers, start + "r2_omega")), text_of(of(numbers, start + "g2_sigma2_omega3"))});
  }
  return html_table(rows);
}

struct Line {
  const char *name, *key, *error_key, *unit;
};

constexpr std::array<Line, 25> lines = {
    {{"energy balance: viscosity from the loss over all three", "energy_balance", "energy_balance_error", ""},
     {"optical depth", "optical_depth", "", ""},
     {"surface density", "surface_density_kg_m2", "", "kg/m²"},
     {"critical wavelength λ_cr", "critical_wavelength_m", "", "m"},
     {"Toomre Q", "toomre_q", "", ""},
     {"Toomre Q without box-long epicyclic waves", "toomre_q_without_waves", "", ""},
     {"Toomre Q by the local dispersion", "local_toomre_q", "", ""},
     {"box-long epicyclic waves: fraction of the epicyclic energy", "epicyclic_wave_fraction", "", ""},
     {"box-long epicyclic waves: the fraction in the first half of the orbits", "epicyclic_wave_fraction_first_half",
      "", ""},
     {"box-long epicyclic waves: the fraction in the last half", "epicyclic_wave_fraction_last_half", "", ""},
     {"scale height √⟨z²⟩", "scale_height_m", "", "m"},
     {"filling factor at z = 0", "filling_factor", "", ""},
     {"optical depth that the mean particle sees", "crowding_optical_depth", "", ""},
     {"share of the area that is thin (τ < 0.1)", "thin_area_share", "", ""},
     {"wakes: pitch by the autocorrelation", "wake_pitch_degrees", "", "degrees"},
     {"wakes: radial spacing by the autocorrelation", "wake_spacing_m", "", "m"},
     {"wakes: wavelength by the spectrum", "wake_wavelength_m", "wake_wavelength_scatter_m", "m"},
     {"wakes: radial wavelength by the spectrum", "wake_radial_wavelength_m", "wake_radial_wavelength_scatter_m", "m"},
     {"wakes: angle by the spectrum", "wake_angle_degrees", "wake_angle_scatter_degrees", "degrees"},
     {"wakes: contrast", "wake_contrast", "", ""},
     {"velocity ellipsoid: vertex deviation", "vertex_deviation_degrees", "", "degrees"},
     {"spins: dispersion", "spin_dispersion_omega", "", "Ω"},
     {"spins: energy over that of the random motion", "spin_energy_ratio", "", ""},
     {"largest overlap of a pair", "largest_overlap", "", "radius sums"},
     {"snapshots that these are means of", "snapshots", "", ""}}};

std::string dispersions(const Json& numbers) {
  Rows rows = {{"velocity dispersion", "radial", "along the orbit", "vertical"}};
  for (const auto& [key, name] :
       {std::pair{"dispersion_m_s", "m/s"}, std::pair{"dispersion_r_omega", "r Ω"},
        std::pair{"dispersion_without_waves_m_s", "m/s, box-long axisymmetric waves taken out"},
        std::pair{"local_dispersion_m_s", "m/s, mean motion of the neighbourhood taken out"}}) {
    const Json c = of(numbers, key);
    if (c.is_array() && c.size() == 3)
      rows.push_back({name, text_of(c[0]), text_of(c[1]), text_of(c[2])});
  }
  return html_table(rows);
}

} // namespace

std::string derived_table(const Scene& scene, const Patch& patch) {
  const double wavelength = critical_wavelength(patch);
  double volume = 0.0;
  for (const double radius : patch.radii)
    volume += 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  const double density = total_mass(patch) / volume;
  const auto text = [](double value) { return figures(value, 4); };
  Rows rows = {{"derived", ""}};
  rows.push_back({"box", fmt::format("{} m × {} m = {} × {} λ_cr", text(patch.box.size_x), text(patch.box.size_y),
                                     text(patch.box.size_x / wavelength), text(patch.box.size_y / wavelength))});
  rows.push_back({"orbital frequency Ω", text(patch.orbital_frequency) + " rad/s"});
  rows.push_back({"κ/Ω, ν/Ω", text(patch.frequencies.kappa) + ", " + text(patch.frequencies.nu)});
  rows.push_back(
      {"mean radius, density of the material", fmt::format("{} m, {} kg/m³", text(mean_radius(patch)), text(density))});
  rows.push_back({"Hill parameter r_h", text(hill_parameter(density, distance_from_saturn(scene.planet)))});
  if (!scene.time.automatic)
    rows.push_back({"step", text(scene.time.step) + " orbits"});
  if (scene.gravity)
    rows.push_back({"drifts a kick", fmt::format("{}", scene.gravity->kick_every)});
  return html_table(rows);
}

std::string measured_tables(const Json& numbers) {
  Rows rows = {{"", "", ""}};
  for (const Line& line : lines)
    if (numbers.contains(line.key))
      rows.push_back({line.name, with_error(of(numbers, line.key), of(numbers, line.error_key)), line.unit});
  rows[0] = {"quantity", "value", "unit"};
  return viscosities(numbers) + dispersions(numbers) + html_table(rows);
}

std::string all_numbers(const Json& numbers) {
  Rows rows = {{"name", "value"}};
  const Json flat = numbers.flatten();
  for (const auto& [path, value] : flat.items())
    rows.push_back({path.substr(1), value.is_null() ? "unknown" : json_text(value)});
  return html_table(rows);
}

} // namespace keeler
