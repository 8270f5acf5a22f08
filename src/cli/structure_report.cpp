#include "structure_report.hpp"

#include <keeler/core/words.hpp>

#include <fmt/format.h>

#include <array>
#include <string>

namespace keeler {
namespace {

nlohmann::ordered_json maybe(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

// NAME_UNIT and NAME_scatter_UNIT.
void put(nlohmann::ordered_json& json, const std::string& name, const char* unit, const Measured& number) {
  json[name + "_" + unit] = maybe(number.value);
  json[name + "_scatter_" + unit] = maybe(number.scatter);
}

// "20.1 +- 1.3 degrees", "unknown".
std::string text(const Measured& number, const char* unit) {
  if (!number.value)
    return "unknown";
  const std::string scatter = number.scatter ? fmt::format(" +- {:.2g}", *number.scatter) : "";
  return fmt::format("{}{} {}", figures(*number.value, 3), scatter, unit);
}

void print_wakes(const Analysis& a) {
  const WakeGeometry& w = a.wakes;
  fmt::print("wake waves           lambda {} across, {} radially, at {}\n", text(w.wavelength, "m"),
             text(w.radial_wavelength, "m"), text(w.angle_degrees, "degrees"));
  fmt::print("wake pitch of parts  inner {}, outer {}\n", text(w.inner_pitch_degrees, "degrees"),
             text(w.outer_pitch_degrees, "degrees"));
}

nlohmann::ordered_json json_of(const SizeClass& c) {
  return {{"smallest_m", c.smallest},
          {"largest_m", c.largest},
          {"count", c.count},
          {"mass_share", c.mass_share},
          {"dispersion_m_s", std::array{c.dispersion.x(), c.dispersion.y(), c.dispersion.z()}},
          {"scale_height_m", c.scale_height}};
}

void add_local(nlohmann::ordered_json& json, const Analysis& a) {
  const LocalAnalysis& l = a.local;
  json["local_radius_m"] = l.radius_m;
  json["local_dispersion_m_s"] = l.dispersion_m_s;
  json["local_toomre_q"] = l.toomre_q;
  json["local_share"] = l.share;
  json["crowding_radius_m"] = l.crowding_radius_m;
  json["crowding_optical_depth"] = l.optical_depth;
  json["crowding_filling_factor"] = l.filling_factor;
  json["thin_area_share"] = l.thin_area_share;
  json["thin_cell_m"] = l.thin_cell_m;
  json["velocity_axis_ratios"] = std::array{a.ellipsoid.second_ratio, a.ellipsoid.vertical_ratio};
  json["vertex_deviation_degrees"] = a.ellipsoid.vertex_deviation_degrees;
  json["size_classes"] = nlohmann::ordered_json::array();
  for (const SizeClass& c : a.size_classes)
    json["size_classes"].push_back(json_of(c));
}

void add_spins(nlohmann::ordered_json& json, const SpinAnalysis& s) {
  json["mean_spin_omega"] = s.mean_omega;
  json["spin_dispersion_omega"] = s.dispersion_omega;
  json["spin_energy_ratio"] = s.energy_ratio;
}

void print_spins(const SpinAnalysis& s) {
  fmt::print(
      "spins                mean {:.3g} {:.3g} {:.3g} Omega, dispersion {:.3g} Omega, {:.3g} of the energy of the "
      "random motion\n",
      s.mean_omega[0], s.mean_omega[1], s.mean_omega[2], s.dispersion_omega, s.energy_ratio);
}

void print_local(const Analysis& a) {
  const LocalAnalysis& l = a.local;
  const auto& c = l.dispersion_m_s;
  fmt::print("local dispersion     {:.3g} {:.3g} {:.3g} m/s within {} m, Toomre Q {:.3g}\n", c[0], c[1], c[2],
             figures(l.radius_m, 3), l.toomre_q);
  fmt::print("the mean particle    sees optical depth {:.3g}, filling factor {:.3g} within {} m\n", l.optical_depth,
             l.filling_factor, figures(l.crowding_radius_m, 3));
  fmt::print("thin area            {:.3g} of the cells of {} m have an optical depth below 0.1\n", l.thin_area_share,
             figures(l.thin_cell_m, 3));
  fmt::print("velocity ellipsoid   axes 1 : {:.3g} : {:.3g}, vertex deviation {:.3g} degrees\n",
             a.ellipsoid.second_ratio, a.ellipsoid.vertical_ratio, a.ellipsoid.vertex_deviation_degrees);
  for (const SizeClass& s : a.size_classes)
    if (s.count > 0)
      fmt::print("r {:>5} to {:<5} m     {}, dispersion {:.3g} {:.3g} {:.3g} m/s, scale height {:.3g} m\n",
                 figures(s.smallest, 3), figures(s.largest, 3), counted(s.count, "particle"), s.dispersion.x(),
                 s.dispersion.y(), s.dispersion.z(), s.scale_height);
}

nlohmann::ordered_json json_of(const RadialModeAnalysis& m) {
  return {{"n", m.n},
          {"wavelength_m", m.wavelength},
          {"density_amplitude", m.density_amplitude},
          {"density_phase_degrees", m.density_phase_degrees},
          {"speed_m_s", m.speed},
          {"growth_rate_omega", m.growth ? nlohmann::ordered_json(m.growth->rate) : nullptr},
          {"growth_rate_error_omega", m.growth ? maybe(m.growth->error) : nullptr}};
}

void print_modes(const Analysis& a) {
  for (const RadialModeAnalysis& m : a.radial_modes) {
    const std::string error = m.growth && m.growth->error ? fmt::format(" +- {:.2g}", *m.growth->error) : std::string();
    fmt::print("radial mode {:<8} {} m, density amplitude {:.3g} (random: {:.2g}), speed {:.3g} m/s, growth {}\n", m.n,
               figures(m.wavelength, 4), m.density_amplitude, a.radial_mode_noise, m.speed,
               m.growth ? fmt::format("{:.3g}{} Omega", m.growth->rate, error) : "unknown");
  }
}

nlohmann::ordered_json json_of(const ClusterAnalysis& c) {
  nlohmann::ordered_json json;
  json["gap"] = c.gap;
  json["count"] = c.count;
  json["mass_share"] = c.mass_share;
  json["largest_mass_share"] = c.largest_mass_share;
  json["largest_half_axes_m"] = c.largest_half_axes ? nlohmann::ordered_json(*c.largest_half_axes) : nullptr;
  json["spin_omega"] = maybe(c.spin);
  json["spectrum"] = nlohmann::ordered_json::array();
  for (const ClusterAnalysis::Class& s : c.spectrum)
    json["spectrum"].push_back({{"least_members", s.least}, {"count", s.count}, {"mass_share", s.mass_share}});
  return json;
}

void print_clusters(const ClusterAnalysis& c) {
  fmt::print("clusters             {} of touching spheres (gap below {} of the radius sum) with {:.3g} of the mass\n",
             figures(c.count, 3), figures(c.gap, 3), c.mass_share);
  if (c.largest_mass_share > 0.0)
    fmt::print("heaviest cluster     {:.3g} of the mass, {}\n", c.largest_mass_share,
               c.largest_half_axes ? fmt::format("half axes {:.3g} {:.3g} {:.3g} m", (*c.largest_half_axes)[0],
                                                 (*c.largest_half_axes)[1], (*c.largest_half_axes)[2])
                                   : "without end in the periodic box");
  if (c.spin)
    fmt::print("spin of clusters     {:.3g} Omega\n", *c.spin);
}

} // namespace

void add_structure(nlohmann::ordered_json& json, const Analysis& a) {
  put(json, "wake_wavelength", "m", a.wakes.wavelength);
  put(json, "wake_radial_wavelength", "m", a.wakes.radial_wavelength);
  put(json, "wake_angle", "degrees", a.wakes.angle_degrees);
  put(json, "wake_inner_pitch", "degrees", a.wakes.inner_pitch_degrees);
  put(json, "wake_outer_pitch", "degrees", a.wakes.outer_pitch_degrees);
  json["wake_contrast"] = a.wakes.contrast;
  add_local(json, a);
  if (a.spins)
    add_spins(json, *a.spins);
  json["clusters"] = json_of(a.clusters);
  json["radial_mode_noise"] = a.radial_mode_noise;
  json["radial_modes"] = nlohmann::ordered_json::array();
  for (const RadialModeAnalysis& m : a.radial_modes)
    json["radial_modes"].push_back(json_of(m));
}

void print_structure(const Analysis& a) {
  print_wakes(a);
  print_local(a);
  if (a.spins)
    print_spins(*a.spins);
  print_clusters(a.clusters);
  print_modes(a);
}

} // namespace keeler
