#include <keeler/runs/analysis_numbers.hpp>

#include <array>
#include <string>

namespace keeler {
namespace {

using Json = nlohmann::ordered_json;

Json maybe(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

// NAME_UNIT and NAME_scatter_UNIT.
void put(Json& json, const std::string& name, const char* unit, const Measured& number) {
  json[name + "_" + unit] = maybe(number.value);
  json[name + "_scatter_" + unit] = maybe(number.scatter);
}

Json numbers_of(const SizeClass& c) {
  return {{"smallest_m", c.smallest},
          {"largest_m", c.largest},
          {"count", c.count},
          {"mass_share", c.mass_share},
          {"dispersion_m_s", std::array{c.dispersion.x(), c.dispersion.y(), c.dispersion.z()}},
          {"scale_height_m", c.scale_height}};
}

void add_local(Json& json, const Analysis& a) {
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
  json["size_classes"] = Json::array();
  for (const SizeClass& c : a.size_classes)
    json["size_classes"].push_back(numbers_of(c));
}

void add_waves(Json& json, const std::optional<WaveAnalysis>& w) {
  json["epicyclic_wave_fraction"] = w ? Json(w->energy_fraction) : nullptr;
  json["dispersion_without_waves_m_s"] = w ? Json(w->dispersion_m_s) : nullptr;
  json["dispersion_without_waves_r_omega"] = w ? Json(w->dispersion_r_omega) : nullptr;
  json["toomre_q_without_waves"] = w ? Json(w->toomre_q) : nullptr;
}

void add_spins(Json& json, const SpinAnalysis& s) {
  json["mean_spin_omega"] = s.mean_omega;
  json["spin_dispersion_omega"] = s.dispersion_omega;
  json["spin_energy_ratio"] = s.energy_ratio;
}

Json numbers_of(const RadialModeAnalysis& m) {
  return {{"n", m.n},
          {"wavelength_m", m.wavelength},
          {"density_amplitude", m.density_amplitude},
          {"density_phase_degrees", m.density_phase_degrees},
          {"speed_m_s", m.speed},
          {"growth_rate_omega", m.growth ? Json(m.growth->rate) : nullptr},
          {"growth_rate_error_omega", m.growth ? maybe(m.growth->error) : nullptr}};
}

Json numbers_of(const ClusterAnalysis& c) {
  Json json;
  json["gap"] = c.gap;
  json["count"] = c.count;
  json["mass_share"] = c.mass_share;
  json["largest_mass_share"] = c.largest_mass_share;
  json["largest_half_axes_m"] = c.largest_half_axes ? Json(*c.largest_half_axes) : nullptr;
  json["spin_omega"] = maybe(c.spin);
  json["spectrum"] = Json::array();
  for (const ClusterAnalysis::Class& s : c.spectrum)
    json["spectrum"].push_back({{"least_members", s.least}, {"count", s.count}, {"mass_share", s.mass_share}});
  return json;
}

void add_structure(Json& json, const Analysis& a) {
  put(json, "wake_wavelength", "m", a.wakes.wavelength);
  put(json, "wake_radial_wavelength", "m", a.wakes.radial_wavelength);
  put(json, "wake_angle", "degrees", a.wakes.angle_degrees);
  put(json, "wake_inner_pitch", "degrees", a.wakes.inner_pitch_degrees);
  put(json, "wake_outer_pitch", "degrees", a.wakes.outer_pitch_degrees);
  json["wake_contrast"] = a.wakes.contrast;
  add_waves(json, a.waves);
  add_local(json, a);
  if (a.spins)
    add_spins(json, *a.spins);
  json["clusters"] = numbers_of(a.clusters);
  json["radial_mode_noise"] = a.radial_mode_noise;
  json["radial_modes"] = Json::array();
  for (const RadialModeAnalysis& m : a.radial_modes)
    json["radial_modes"].push_back(numbers_of(m));
}

} // namespace

Json numbers_of(const Analysis& a, double overlap) {
  Json json;
  json["snapshots"] = a.snapshots;
  json["time_orbits"] = a.time_orbits;
  json["particle_count"] = a.particle_count;
  json["mean_radius_m"] = a.mean_radius_m;
  json["optical_depth"] = a.optical_depth;
  json["surface_density_kg_m2"] = a.surface_density_kg_m2;
  json["critical_wavelength_m"] = a.critical_wavelength_m;
  json["toomre_q"] = a.toomre_q;
  json["dispersion_m_s"] = a.dispersion_m_s;
  json["dispersion_r_omega"] = a.dispersion_r_omega;
  json["scale_height_m"] = a.scale_height_m;
  json["mean_eccentricity_m"] = a.mean_eccentricity_m;
  json["mean_inclination_m"] = a.mean_inclination_m;
  json["filling_factor"] = a.filling_factor;
  json["random_energy_m2_s2"] = a.random_energy_m2_s2;
  json["largest_overlap"] = overlap;
  json["wake_pitch_degrees"] = maybe(a.wake_pitch_degrees);
  json["wake_spacing_m"] = maybe(a.wake_spacing_m);
  json["wake_amplitude"] = a.wake_amplitude;
  add_structure(json, a);
  return json;
}

} // namespace keeler
