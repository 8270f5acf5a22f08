#include <keeler/runs/measurement.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/registry.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/wake_geometry.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/own_numbers.hpp>
#include <keeler/runs/patch_units.hpp>

#include <algorithm>
#include <array>
#include <cassert>

namespace keeler::runs {
namespace {

namespace unit = quantities::unit;
using quantities::Forms, quantities::Quantity, quantities::QuantityRow, quantities::Record, quantities::Shape,
    quantities::Spread, quantities::Uncertain, quantities::Unknown, quantities::Value, quantities::of_digits,
    quantities::value_of;
using Source = const Measurement&;
using Rows = std::vector<QuantityRow<Measurement>>;

Value vector_of(const std::array<double, 3>& axes) {
  return std::vector<double>(axes.begin(), axes.end());
}

Value vector_of(const Vec3& axes) {
  return std::vector<double>{axes.x(), axes.y(), axes.z()};
}

Rows state_rows() {
  return {
      {{"snapshots", unit::none, "snapshots", "number of snapshots averaged over"},
       [](Source m) { return m.analysis.snapshots; }},
      {{"time", unit::orbits, "time of the last", "time of the last snapshot since the run began"},
       [](Source m) { return m.analysis.time_orbits; }},
      {{"particle_count", unit::none, "particles", "N"}, [](Source m) { return m.analysis.particle_count; }},
      {{"mean_radius", unit::metres, "mean radius r", "plain mean of the radii: the r of r Ω"},
       [](Source m) { return m.analysis.mean_radius_m; }},
      {{"optical_depth", unit::none, "optical depth", "geometric: Σ π r² over the area"},
       [](Source m) { return m.analysis.optical_depth; }},
      {{"surface_density", unit::surface_density, "surface density", "Σ m over the area"},
       [](Source m) { return m.analysis.surface_density_kg_m2; }},
      {{"critical_wavelength", unit::metres, "critical wavelength", "λ_cr = 4π² G Σ/κ² (Toomre 1964)"},
       [](Source m) { return m.analysis.critical_wavelength_m; }},
      {{"toomre_q", unit::none, "Toomre Q", "κ c_x/(3.36 G Σ), with c_x of the whole patch (Toomre 1964)"},
       [](Source m) { return m.analysis.toomre_q; }},
      {{"gravity_parameter", unit::none, "gravity parameter",
        "(G Σ/(r Ω²))²: the unit of viscosity by self-gravity, G²Σ²/Ω³, over that by contacts, r²Ω (Daisaka, Tanaka & "
        "Ida 2001, Icarus 154, 296)"},
       [](Source m) {
         return m.units.viscosity(quantities::UnitSystem::gravity) / m.units.viscosity(quantities::UnitSystem::radius);
       }},
      {of_shape({"dispersion", unit::metres_per_second, "velocity dispersion",
                 "c_x, c_y, c_z: standard deviation of the velocity beyond the shear, streams of wakes included",
                 Spread::none, Forms::si_and_radius},
                Shape::vector),
       [](Source m) { return vector_of(m.analysis.dispersion_m_s); }},
      {{"scale_height", unit::metres, "scale height", "√⟨z²⟩"}, [](Source m) { return m.analysis.scale_height_m; }},
      {{"mean_eccentricity", unit::metres, "", "mean amplitude of the epicycles along the radius"},
       [](Source m) { return m.mean_over_snapshots(diagnostics::mean_eccentricity); }},
      {{"mean_inclination", unit::metres, "", "mean amplitude of the vertical oscillations"},
       [](Source m) { return m.mean_over_snapshots(diagnostics::mean_inclination); }},
      {{"filling_factor", unit::none, "filling factor", "fraction of the plane z = 0 inside particles"},
       [](Source m) { return m.mean_over_snapshots(diagnostics::midplane_filling); }},
      {{"random_energy", unit::specific_energy, "",
        "⟨½κ²e² + ½ν²i²⟩ per mass without the mean motion, which free epicycles keep"},
       [](Source m) { return m.analysis.random_energy_m2_s2; }},
      {of_digits(2, {"largest_overlap", unit::unnamed("of a radius sum"), "largest overlap",
                     "largest (r₁ + r₂ − distance)/(r₁ + r₂) of any pair in any of the snapshots; 0: none"}),
       [](Source m) { return m.largest_overlap; }}};
}

std::string why_no_wakes(const diagnostics::Analysis& a) {
  return a.wake_amplitude > 0.0 ? "no wakes exceed the noise" : "these particles are too few to resolve λ_cr";
}

Rows wake_rows() {
  return {
      {of_digits(
           3, {"wake_pitch", unit::degrees, "wakes: pitch",
               "angle from the orbit to the central ridge of the autocorrelation out to one λ_cr; positive: trailing"}),
       [](Source m) { return value_of(m.analysis.wake_pitch_degrees, why_no_wakes(m.analysis)); }},
      {of_digits(3, {"wake_spacing", unit::metres, "wakes: radial spacing",
                     "radial distance to the first side maximum of the mean autocorrelation"}),
       [](Source m) {
         return value_of(m.analysis.wake_spacing_m, m.analysis.wake_pitch_degrees
                                                        ? "no second wake exceeds the noise within half a box"
                                                        : why_no_wakes(m.analysis));
       }},
      {of_digits(3, {"wake_amplitude", unit::none, "wakes: amplitude",
                     "how far the ridge of the autocorrelation stands out"}),
       [](Source m) { return m.analysis.wake_amplitude; }},
      {of_digits(
           3,
           {"wake_wavelength", unit::metres, "wakes: wavelength",
            "λ_⊥ = 2π Σ P/Σ P k of the power spectrum P of the surface density, smoothed by λ_cr/8; null without wakes",
            Spread::scatter}),
       [](Source m) { return value_of(m.analysis.wakes.wavelength, why_no_wakes(m.analysis)); }},
      {of_digits(3, {"wake_radial_wavelength", unit::metres, "wakes: radial wavelength",
                     "λ_x = 2π Σ P/Σ P k_x, k_x counted as positive", Spread::scatter}),
       [](Source m) { return value_of(m.analysis.wakes.radial_wavelength, why_no_wakes(m.analysis)); }},
      {of_digits(3, {"wake_angle", unit::degrees, "wakes: angle", "from the orbit to the wakes by the power spectrum",
                     Spread::scatter}),
       [](Source m) { return value_of(m.analysis.wakes.angle_degrees, why_no_wakes(m.analysis)); }},
      {of_digits(3, {"wake_inner_pitch", unit::degrees, "wakes: inner pitch",
                     "of the ridge within λ_cr/2 (after Michikoshi et al. 2015, ApJ 812, 151)", Spread::scatter}),
       [](Source m) { return value_of(m.analysis.wakes.inner_pitch_degrees, why_no_wakes(m.analysis)); }},
      {of_digits(3, {"wake_outer_pitch", unit::degrees, "wakes: outer pitch", "of the ridge from λ_cr/2 to 3/2 λ_cr",
                     Spread::scatter}),
       [](Source m) { return value_of(m.analysis.wakes.outer_pitch_degrees); }},
      {{"wake_contrast", unit::none, "wakes: contrast", "rms of the smoothed Σ/⟨Σ⟩ − 1, without shot noise"},
       [](Source m) { return m.analysis.wakes.contrast; }}};
}

// Returns a number of the waves; unknown if there are too few particles.
Value of_waves(Source m, const std::function<Value(const diagnostics::WaveAnalysis&)>& number) {
  return m.analysis.waves ? number(*m.analysis.waves) : Unknown{"these particles are too few"};
}

Rows wave_rows() {
  return {{{"epicyclic_wave_fraction", unit::none, "box-long waves: energy",
            "fraction of the epicyclic energy in axisymmetric waves as long as the box (modes 1 to 4)"},
           [](Source m) { return of_waves(m, [](const diagnostics::WaveAnalysis& w) { return w.energy_fraction; }); }},
          {of_shape({"dispersion_without_waves", unit::metres_per_second, "dispersion without them",
                     "about the velocity field of these waves", Spread::none, Forms::si_and_radius},
                    Shape::vector),
           [](Source m) {
             return of_waves(m, [](const diagnostics::WaveAnalysis& w) { return vector_of(w.dispersion_m_s); });
           }},
          {{"toomre_q_without_waves", unit::none, "Toomre Q without them",
            "κ c_x/(3.36 G Σ) by the dispersion without these waves"},
           [](Source m) { return of_waves(m, [](const diagnostics::WaveAnalysis& w) { return w.toomre_q; }); }}};
}

std::vector<Record> size_classes_of(Source m) {
  using Class = const diagnostics::SizeClass&;
  static const std::vector<QuantityRow<diagnostics::SizeClass>> rows = {
      {{"smallest", unit::metres, "from"}, [](Class c) { return c.smallest; }},
      {{"largest", unit::metres, "to"}, [](Class c) { return c.largest; }},
      {{"count", unit::none, "particles"}, [](Class c) { return c.count; }},
      {{"mass_share", unit::none, ""}, [](Class c) { return c.mass_fraction; }},
      {{"dispersion", unit::metres_per_second, "dispersion"}, [](Class c) { return vector_of(c.dispersion); }},
      {{"scale_height", unit::metres, "scale height"}, [](Class c) { return c.scale_height; }}};
  std::vector<Record> classes;
  for (const diagnostics::SizeClass& c : m.analysis.size_classes)
    classes.push_back({entries_of(rows, c), m.units});
  return classes;
}

Rows local_rows() {
  return {
      {{"local_radius", unit::metres, "local: within",
        "radius of the neighbourhood whose mean velocity is subtracted: the larger of 3 r and λ_cr/20"},
       [](Source m) { return m.analysis.local.radius_m; }},
      {of_shape({"local_dispersion", unit::metres_per_second, "local: dispersion",
                 "standard deviation of the velocities about the mean of the neighbours"},
                Shape::vector),
       [](Source m) { return vector_of(m.analysis.local.dispersion_m_s); }},
      {{"local_toomre_q", unit::none, "local: Toomre Q", "by the local c_x and the mean Σ of the patch"},
       [](Source m) { return m.analysis.local.toomre_q; }},
      {{"local_share", unit::none, "", "mass fraction of the particles that have a neighbour"},
       [](Source m) { return m.analysis.local.fraction; }},
      {{"crowding_radius", unit::metres, "mean over particles: within",
        "radius of the disc about each particle in which density is counted: the larger of 6 r and λ_cr/10"},
       [](Source m) { return m.analysis.local.crowding_radius_m; }},
      {{"crowding_optical_depth", unit::none, "mean over particles: optical depth",
        "of the other particles within that disc"},
       [](Source m) { return m.analysis.local.optical_depth; }},
      {{"crowding_filling_factor", unit::none, "mean over particles: filling factor",
        "of the other particles there at z = 0"},
       [](Source m) { return m.analysis.local.filling_factor; }},
      {{"thin_area_share", unit::none, "thin area (τ < 0.1)", "fraction of cells with an optical depth below 0.1"},
       [](Source m) { return m.analysis.local.thin_area_fraction; }},
      {{"thin_cell", unit::metres, "", "side of these cells"}, [](Source m) { return m.analysis.local.thin_cell_m; }},
      {of_shape({"velocity_axis_ratios", unit::none, "velocity ellipsoid: ratios",
                 "c₂/c₁ and c_z/c₁ of the principal axes of the velocity ellipsoid"},
                Shape::other),
       [](Source m) {
         return std::vector{m.analysis.ellipsoid.second_ratio, m.analysis.ellipsoid.vertical_ratio};
       }},
      {{"vertex_deviation", unit::degrees, "velocity ellipsoid: deviation",
        "angle from the radius to its longest axis, positive towards the orbital motion"},
       [](Source m) { return m.analysis.ellipsoid.vertex_deviation_degrees; }},
      {of_shape({"size_classes", unit::none, "radii",
                 "`count`, `mass_share`, `dispersion_m_s`, `scale_height_m` of radii from `smallest_m` to `largest_m`"},
                Shape::other),
       [](Source m) { return size_classes_of(m); }}};
}

bool has_spins(Source m) {
  return m.analysis.spins.has_value();
}

Rows spin_rows() {
  return {{of_shape(
               {"mean_spin", unit::omega, "spins: mean", "mean angular velocity against the stars; only with friction"},
               Shape::vector),
           [](Source m) { return vector_of(m.analysis.spins->mean_omega); }, has_spins},
          {{"spin_dispersion", unit::omega, "spins: dispersion", "√⟨(ω − ⟨ω⟩)²⟩; only with friction"},
           [](Source m) { return m.analysis.spins->dispersion_omega; },
           has_spins},
          {{"spin_energy_ratio", unit::none, "spins: energy ratio",
            "energy of the spins about their mean over that of the random motion; only with friction"},
           [](Source m) { return m.analysis.spins->energy_ratio; },
           has_spins}};
}

std::vector<Record> spectrum_of(Source m) {
  using Class = diagnostics::ClusterAnalysis::Class;
  static const std::vector<QuantityRow<Class>> rows = {
      {{"least_members"}, [](const Class& c) { return c.min_members; }},
      {{"count"}, [](const Class& c) { return c.count; }},
      {{"mass_share"}, [](const Class& c) { return c.mass_fraction; }}};
  std::vector<Record> classes;
  for (const Class& c : m.analysis.clusters.spectrum)
    classes.push_back({entries_of(rows, c), m.units});
  return classes;
}

Rows cluster_rows() {
  return {{{"clusters.gap", unit::none, "",
            "largest gap between friends, over the sum of their radii (friends of friends)"},
           [](Source m) { return m.analysis.clusters.gap; }},
          {of_digits(
               3, {"clusters.count", unit::none, "clusters", "clusters of two or more touching spheres, per snapshot"}),
           [](Source m) { return m.analysis.clusters.count; }},
          {{"clusters.mass_share", unit::unnamed("of the mass"), "clusters: all", "fraction of all mass in them"},
           [](Source m) { return m.analysis.clusters.mass_fraction; }},
          {{"clusters.largest_mass_share", unit::unnamed("of the mass"), "clusters: the heaviest",
            "fraction of all mass in the heaviest one"},
           [](Source m) { return m.analysis.clusters.largest_mass_fraction; }},
          {of_shape({"clusters.largest_half_axes", unit::metres, "clusters: its half axes",
                     "half axes of the homogeneous ellipsoid with the moments of inertia of the heaviest one"},
                    Shape::vector),
           [](Source m) -> Value {
             const auto& axes = m.analysis.clusters.largest_half_axes;
             return axes ? vector_of(*axes)
                         : Unknown{m.analysis.clusters.count > 0.0 ? "it is unbounded in the periodic box"
                                                                   : "there are none"};
           }},
          {{"clusters.spin", unit::omega, "clusters: spin", "1 + L_z/I_z, seen from the stars; mean over their mass"},
           [](Source m) { return value_of(m.analysis.clusters.spin); }},
          {of_shape({"clusters.spectrum", unit::none, "",
                     "`count` and `mass_share` of clusters of `least_members` to twice as many"},
                    Shape::other),
           [](Source m) { return spectrum_of(m); }}};
}

std::vector<Record> radial_modes_of(Source m) {
  using Mode = const diagnostics::RadialModeAnalysis&;
  static const std::vector<QuantityRow<diagnostics::RadialModeAnalysis>> rows = {
      {{"n", unit::none, "n"}, [](Mode mode) { return static_cast<std::uint64_t>(mode.n); }},
      {{"wavelength", unit::metres, "wavelength"}, [](Mode mode) { return mode.wavelength; }},
      {{"density_amplitude", unit::none, "amplitude"}, [](Mode mode) { return mode.density_amplitude; }},
      {{"density_phase", unit::degrees}, [](Mode mode) { return mode.density_phase_degrees; }},
      {{"speed", unit::metres_per_second, "speed"}, [](Mode mode) { return mode.speed; }},
      {of_digits(3, {"growth_rate", unit::omega, "growth", "", Spread::error}), [](Mode mode) {
         return mode.growth ? Value(Uncertain{mode.growth->rate, mode.growth->error}) : Value(Unknown{});
       }}};
  std::vector<Record> modes;
  for (const diagnostics::RadialModeAnalysis& mode : m.analysis.radial_modes)
    modes.push_back({entries_of(rows, mode), m.units});
  return modes;
}

Rows mode_rows() {
  return {
      {of_digits(2, {"radial_mode_noise", unit::none, "radial modes: noise",
                     "rms density amplitude of a mode of particles at random: 2 √(Σm²)/Σm"}),
       [](Source m) { return m.analysis.radial_mode_noise; }},
      {of_shape(
           {"radial_modes", unit::none, "radial mode",
            "waves along the radius: `n`, `wavelength_m`, `density_amplitude`, `density_phase_degrees`, `speed_m_s`, "
            "`growth_rate_omega`, `growth_rate_error_omega`"},
           Shape::other),
       [](Source m) { return radial_modes_of(m); }}};
}

const Rows& all_rows() {
  static const Rows all = [] {
    Rows rows;
    for (const auto part : {state_rows, wake_rows, wave_rows, local_rows, spin_rows, cluster_rows, mode_rows})
      rows = joined(std::move(rows), part());
    return rows;
  }();
  return all;
}

Registry<OwnQuantity>& registered_quantities() {
  static Registry<OwnQuantity> quantities("quantity", &OwnQuantity::name, {});
  return quantities;
}

Quantity quantity_of(const OwnQuantity& own) {
  return {own.name, unit::unnamed(own.unit), own.label, own.meaning};
}

std::vector<quantities::Entry> own_entries(Source m) {
  std::vector<quantities::Entry> entries;
  for (const OwnQuantity& own : registered_quantities().entries())
    entries.push_back({quantity_of(own), value_of(std::optional(m.mean_over_snapshots(own.value)))});
  return entries;
}

std::vector<Quantity> own_quantities() {
  std::vector<Quantity> all;
  for (const OwnQuantity& own : registered_quantities().entries())
    all.push_back(quantity_of(own));
  return all;
}

} // namespace

void add_quantity(const OwnQuantity& own, IfTaken if_taken) {
  if (own.name && find_quantity(joined(quantities_of(all_rows()), transport_quantities()), own.name))
    fail_taken("quantity", own.name);
  registered_quantities().add(own, if_taken);
  assert(own.value && "a quantity has a function");
}

std::string analyze_json(const std::filesystem::path& path) {
  const MeasuredPart part = measured_part(path, {});
  return json_text(json_of(record_of(measure(part.stored.patches, part.transport))), 2);
}

double Measurement::mean_over_snapshots(const std::function<double(const Patch&)>& value) const {
  assert(!patches.empty());
  const double weight = 1.0 / static_cast<double>(patches.size());
  double mean = 0.0;
  for (const Patch& patch : patches)
    mean += weight * value(patch);
  return mean;
}

Measurement measure(std::span<const Patch> patches, const TransportReport& transport,
                    const diagnostics::AnalysisSettings& settings, const std::function<void()>& patch_done) {
  assert(!patches.empty());
  Measurement m{patches, analyze(patches, settings), 0.0, transport, units_of(patches.back())};
  for (const Patch& patch : patches) {
    m.largest_overlap = std::max(m.largest_overlap, cells::largest_overlap(patch).depth);
    if (patch_done)
      patch_done();
  }
  return m;
}

Record wakes_of(std::span<const Patch> patches) {
  assert(!patches.empty());
  static const Rows rows = wake_rows();
  Measurement m;
  m.patches = patches;
  m.analysis.take_wakes(diagnostics::wake_geometry(patches, m.mean_over_snapshots(diagnostics::critical_wavelength)));
  return {entries_of(rows, m), units_of(patches.back())};
}

Record record_of(const Measurement& measurement) {
  const Record transport = record_of(measurement.transport, measurement.units);
  return {joined(joined(entries_of(all_rows(), measurement), transport.entries), own_entries(measurement)),
          measurement.units};
}

std::vector<Quantity> measured_quantities() {
  return joined(joined(quantities_of(all_rows()), transport_quantities()), own_quantities());
}

} // namespace keeler::runs
