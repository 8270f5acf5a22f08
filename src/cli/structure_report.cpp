#include "structure_report.hpp"

#include "print.hpp"

#include <keeler/core/words.hpp>

#include <fmt/format.h>

#include <array>
#include <string>

namespace keeler {
namespace {

// "20.1 +- 1.3 degrees", "unknown".
std::string text(const Measured& number, const char* unit) {
  if (!number.value)
    return "unknown";
  const std::string scatter = number.scatter ? fmt::format(" +- {:.2g}", *number.scatter) : "";
  return fmt::format("{}{} {}", figures(*number.value, 3), scatter, unit);
}

void print_wakes(const Analysis& a) {
  const WakeGeometry& w = a.wakes;
  print("wake waves           lambda {} across, {} radially, at {}\n", text(w.wavelength, "m"),
        text(w.radial_wavelength, "m"), text(w.angle_degrees, "degrees"));
  print("wake pitch of parts  inner {}, outer {}\n", text(w.inner_pitch_degrees, "degrees"),
        text(w.outer_pitch_degrees, "degrees"));
}

void print_spins(const SpinAnalysis& s) {
  print("spins                mean {:.3g} {:.3g} {:.3g} Omega, dispersion {:.3g} Omega, {:.3g} of the energy of the "
        "random motion\n",
        s.mean_omega[0], s.mean_omega[1], s.mean_omega[2], s.dispersion_omega, s.energy_ratio);
}

void print_epicyclic_waves(const WaveAnalysis& w) {
  const auto& c = w.dispersion_m_s;
  print("box-long waves       {:.2g} of the epicyclic energy, axisymmetric; without them Toomre Q {:.3g}, dispersion "
        "{:.3g} {:.3g} {:.3g} m/s\n",
        w.energy_fraction, w.toomre_q, c[0], c[1], c[2]);
}

void print_local(const Analysis& a) {
  const LocalAnalysis& l = a.local;
  const auto& c = l.dispersion_m_s;
  print("local dispersion     {:.3g} {:.3g} {:.3g} m/s within {} m, Toomre Q {:.3g}\n", c[0], c[1], c[2],
        figures(l.radius_m, 3), l.toomre_q);
  print("the mean particle    sees optical depth {:.3g}, filling factor {:.3g} within {} m\n", l.optical_depth,
        l.filling_factor, figures(l.crowding_radius_m, 3));
  print("thin area            {:.3g} of the cells of {} m have an optical depth below 0.1\n", l.thin_area_share,
        figures(l.thin_cell_m, 3));
  print("velocity ellipsoid   axes 1 : {:.3g} : {:.3g}, vertex deviation {:.3g} degrees\n", a.ellipsoid.second_ratio,
        a.ellipsoid.vertical_ratio, a.ellipsoid.vertex_deviation_degrees);
  for (const SizeClass& s : a.size_classes)
    if (s.count > 0)
      print("r {:>5} to {:<5} m     {}, dispersion {:.3g} {:.3g} {:.3g} m/s, scale height {:.3g} m\n",
            figures(s.smallest, 3), figures(s.largest, 3), counted(s.count, "particle"), s.dispersion.x(),
            s.dispersion.y(), s.dispersion.z(), s.scale_height);
}

void print_modes(const Analysis& a) {
  for (const RadialModeAnalysis& m : a.radial_modes) {
    const std::string error = m.growth && m.growth->error ? fmt::format(" +- {:.2g}", *m.growth->error) : std::string();
    print("radial mode {:<8} {} m, density amplitude {:.3g} (random: {:.2g}), speed {:.3g} m/s, growth {}\n", m.n,
          figures(m.wavelength, 4), m.density_amplitude, a.radial_mode_noise, m.speed,
          m.growth ? fmt::format("{:.3g}{} Omega", m.growth->rate, error) : "unknown");
  }
}

void print_clusters(const ClusterAnalysis& c) {
  print("clusters             {} of touching spheres (gap below {} of the radius sum) with {:.3g} of the mass\n",
        figures(c.count, 3), figures(c.gap, 3), c.mass_share);
  if (c.largest_mass_share > 0.0)
    print("heaviest cluster     {:.3g} of the mass, {}\n", c.largest_mass_share,
          c.largest_half_axes ? fmt::format("half axes {:.3g} {:.3g} {:.3g} m", (*c.largest_half_axes)[0],
                                            (*c.largest_half_axes)[1], (*c.largest_half_axes)[2])
                              : "without end in the periodic box");
  if (c.spin)
    print("spin of clusters     {:.3g} Omega\n", *c.spin);
}

} // namespace

void print_structure(const Analysis& a) {
  print_wakes(a);
  if (a.waves)
    print_epicyclic_waves(*a.waves);
  print_local(a);
  if (a.spins)
    print_spins(*a.spins);
  print_clusters(a.clusters);
  print_modes(a);
}

} // namespace keeler
