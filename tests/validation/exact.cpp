// Exact solutions.
#include "rows.hpp"

#include <keeler/core/linear_algebra.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/transmission.hpp>
#include <keeler/gravity/fft.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include "lattice.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::validation {
namespace {

constexpr double elevations[] = {5.0, 15.0, 30.0, 60.0, 90.0}; // degrees

Patch empty_patch(double size_x, double size_y) {
  Patch patch;
  patch.box = {size_x, size_y, 1.5, 0.0};
  patch.orbital_frequency = 1e-4;
  return patch;
}

void add_sphere(Patch& patch, const Vec3& place, double radius) {
  patch.positions.push_back(place);
  patch.velocities.push_back(Vec3::Zero());
  patch.radii.push_back(radius);
  patch.masses.push_back(1.0);
  patch.ids.push_back(patch.ids.size());
}

double transmission_of(const Patch& patch, double elevation, double azimuth) {
  const diagnostics::RayLattice rays(patch.box, 4'000'000, patch.box.size_x);
  const std::vector<std::uint8_t> blocked = rays.blocked(patch, {elevation * pi / 180.0, azimuth});
  const auto stopped = static_cast<double>(std::count(blocked.begin(), blocked.end(), 1));
  return 1.0 - stopped / static_cast<double>(blocked.size());
}

// N shadows of area a thrown independently on A leave (1 − a/A)^N; the layer is thick, so heights are independent too.
std::vector<Row> uniform_layer() {
  constexpr std::size_t count = 20'000;
  Patch patch = empty_patch(500.0, 400.0);
  RandomStream random(5, RandomPurpose::position, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const double x = random.uniform() - 0.5, y = random.uniform() - 0.5, z = random.uniform() - 0.5;
    add_sphere(patch, {500.0 * x, 400.0 * y, 200.0 * z}, 1.0);
  }
  std::vector<Row> rows;
  for (const double b : elevations) {
    const double shadow = pi / std::sin(b * pi / 180.0) / patch.box.area(), n = static_cast<double>(count);
    const double expected = std::pow(1.0 - shadow, n), tau = n * shadow;
    // variance of the area that N shadows at random leave free is below T τ a/A
    const double scatter = std::sqrt(expected * tau * shadow) + 1e-4;
    rows.push_back({.what = fmt::format("transmission of a layer at random, B = {} degrees", b),
                    .measured = transmission_of(patch, b, 0.7),
                    .expected = expected,
                    .tolerance = 3.0 * scatter,
                    .tolerance_is = "three times its scatter",
                    .source = "(1 - a/A)^N, a the area of a shadow",
                    .command = fmt::format("{} spheres, seed 5, 4 million rays", count)});
  }
  return rows;
}

// Spheres so close along y that they make a cylinder: across it the shadow is 2 r/sin B wide, so rows at a distance D
// leave 1 − 2 r/(D sin B) of the light.
std::vector<Row> cylinders() {
  constexpr double distance = 40.0, length = 20.0;
  Patch patch = empty_patch(distance, length);
  for (int k = 0; k < 1000; ++k)
    add_sphere(patch, {1.0, length * (0.001 * k - 0.5), 0.0}, 1.0);
  std::vector<Row> rows;
  for (const double b : elevations)
    rows.push_back({.what = fmt::format("transmission of cylinders, across, B = {} degrees", b),
                    .measured = transmission_of(patch, b, 0.0),
                    .expected = 1.0 - 2.0 / (distance * std::sin(b * pi / 180.0)),
                    .tolerance = 5e-4,
                    .tolerance_is = "of 4 million rays, stratified",
                    .source = "1 - 2 r/(D sin B)",
                    .command = "spheres of 1 m every 0.02 m along y, rows every 40 m"});
  return rows;
}

// Φ of all pairs and images of a patch that is sheared by a small strain, each pair by Ewald's sum.
double exact_potential(const Patch& patch, double strain) {
  const gravity::Lattice lattice(patch.box, patch.offset + strain * patch.box.size_x, 1e-9);
  const auto place = [&](std::size_t k) {
    const Vec3& p = patch.positions[k];
    return Vec3(p.x(), p.y() - strain * p.x(), p.z());
  };
  return ordered_sum(patch.size(), [&](std::size_t i) {
    double sum = 0.5 * patch.masses[i] * lattice.potential(Vec3::Zero());
    for (std::size_t j = 0; j < i; ++j)
      sum += patch.masses[j] * lattice.potential(place(i) - place(j));
    return patch.masses[i] * sum;
  });
}

std::vector<Row> gravitational_stress() {
  const Ran ran = run_example("a-ring-wakes", {"gravity={solver=\"fft\",force_error=2e-3,kick_every=1}",
                                               "time.step=1e-3", "box.size_in_wavelengths=[1.5,1.5]", "time.end=3"});
  const Patch& patch = ran.snapshots.back();
  constexpr double strain = 2e-3;
  const double g = newton_g(patch.orbital_frequency);
  const double exact = g * (exact_potential(patch, strain) - exact_potential(patch, -strain)) / (2.0 * strain);
  double mass = 0.0;
  for (const double m : patch.masses)
    mass += m;
  const double unit = mass * patch.box.shear / patch.orbital_frequency; // to a viscosity in m²/s
  const auto meter =
      gravity::make_energy_meter({.solver = GravitySettings::Solver::fft}, patch.masses, patch.box.area());
  const gravity::GravityEnergy measured =
      meter->energy({patch.positions, patch.masses, patch.ids, patch.box, patch.offset, g});
  return {{.what = "gravitational viscosity of wakes, m^2/s",
           .measured = measured.stress / unit,
           .expected = exact / unit,
           .tolerance = 0.01 * std::fabs(exact / unit),
           .tolerance_is = "1 %",
           .source = "slope of the potential energy of all pairs and images under a shear of 0.002 (Ewald's sum)",
           .command = ran.command}};
}

// The displacement that alternates from mass to mass, and its velocity: one number each of x and y.
Eigen::Vector4d alternating(const Patch& patch, double spacing) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  const auto count = static_cast<double>(patch.size());
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0, home = (static_cast<double>(k) - 0.5 * count + 0.5) * spacing;
    sum += sign / count *
           Eigen::Vector4d(patch.positions[k].x(), patch.positions[k].y() - home, patch.velocities[k].x(),
                           patch.velocities[k].y());
  }
  return sum;
}

// The growth rate of the fastest mode, by the map of one sample to the next, which is linear.
double string_growth(const std::string& solver, double g) {
  constexpr double spacing = 1.0, omega = 1e-4;
  constexpr int count = 16, samples = 24, steps = 40;
  const Scene scene = parse_scene(fmt::format(R"(
[planet]
orbital_frequency = {}
[box]
size = [400.0, 16.0]
[particles]
count = 16
density = 1000.0
sizes = {{ law = "equal", radius = 1e-3 }}
[gravity]
solver = "{}"
{}
[time]
step = 1e-3
end = 1.0
)",
                                              omega, solver, solver == "tree" ? "opening_angle = 0.4" : ""),
                                  "the string");
  Patch patch = empty_patch(400.0, 16.0);
  patch.orbital_frequency = omega;
  RandomStream random(1, RandomPurpose::position, 0);
  const Vec3 start = 1e-5 * Vec3(random.normal(), random.normal(), 0.0),
             speed = 1e-5 * Vec3(random.normal(), random.normal(), 0.0);
  for (int k = 0; k < count; ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    add_sphere(patch, Vec3(0.0, (k - 0.5 * count + 0.5) * spacing, 0.0) + sign * start, 1e-3);
    patch.masses.back() = g * spacing * spacing * spacing / newton_g(omega);
    patch.velocities.back() = sign * speed - Vec3(0.0, 1.5 * sign * start.x(), 0.0);
  }
  Simulation simulation(scene, patch);
  Eigen::Matrix<double, 4, samples> states;
  for (int k = 0; k < samples; ++k) {
    states.col(k) = alternating(simulation.patch(), spacing);
    for (int step = 0; step < steps; ++step)
      simulation.advance();
  }
  const auto before = states.leftCols<samples - 1>(), after = states.rightCols<samples - 1>();
  const Eigen::Matrix4d map = least_squares(before.transpose(), after.transpose()).solution.transpose();
  return std::log(map.eigenvalues().cwiseAbs().maxCoeff()) / (steps * scene.step_length());
}

// Maxwell's string: masses m on a line along y at spacing d, g = Gm/(Ω²d³). With q = 2 g Σ (1 − cos nθ)/n³ the modes
// obey s⁴ + (1 − q) s² + 2 q (3 − q) = 0; θ = π goes unstable first, at g = 0.0092669.
std::vector<Row> maxwells_string() {
  struct Known {
    double over_critical, growth;
  };
  std::vector<Row> rows;
  for (const auto& [solver, error] : {std::pair("direct", 3e-5), {"tree", 1e-3}, {"fft", 2e-3}})
    for (const Known& k : {Known{0.99, 0.0}, {1.01, 0.035775}, {1.5, 0.240622}, {2.0, 0.327137}, {4.0, 0.509812}}) {
      const bool exact = std::string(solver) == "direct";
      if (k.over_critical < 1.5 && !exact)
        continue;
      rows.push_back({.what = fmt::format("growth / Omega of Maxwell's string, {}, {} of the critical mass",
                                          exact                           ? "direct"
                                          : solver == std::string("tree") ? "tree at 0.4"
                                                                          : "fft",
                                          k.over_critical),
                      .measured = string_growth(solver, k.over_critical * 0.0092669),
                      .expected = k.growth,
                      .tolerance = exact ? 1e-4 : 3.0 * error * k.growth,
                      .tolerance_is = exact ? "of the step, 1/1000 orbit" : "three times the rms error of the force",
                      .source = "s^4 + (1 - q) s^2 + 2 q (3 - q) = 0 (Maxwell 1859)",
                      .command = "16 masses in 400 x 16 spacings, a disturbance of 1e-5, 0.96 orbits"});
    }
  return rows;
}

// Where a perturbed ring carries no angular momentum: flux over the first orbit at several bunchings q, and its zero.
std::vector<Row> flux_reversal() {
  const double bunchings[] = {0.78, 0.82, 0.86};
  double collisional[3], total[3];
  std::string command;
  for (int k = 0; k < 3; ++k) {
    const Ran ran = run_example("perturbed-ring", {fmt::format("particles.streamlines.bunching={}", bunchings[k]),
                                                   "particles.streamlines.inclination=0", "box.size=[400,400]",
                                                   "time.end=1", "output.series_every=0.05"});
    const std::vector<double>& transport = ran.series.of("translational_flux_kg_m2_s");
    collisional[k] = ran.series.of("collisional_flux_kg_m2_s").back();
    total[k] = collisional[k] + transport.back() - transport[transport.size() / 2];
    command = ran.command;
  }
  const auto zero = [&](const double* flux) { // of the line through the first and the last
    return bunchings[0] + (bunchings[2] - bunchings[0]) * flux[0] / (flux[0] - flux[2]);
  };
  const auto row = [&](const char* what, const double* flux, double tolerance, const char* tolerance_is) {
    return Row{.what = what,
               .measured = zero(flux),
               .expected = std::sqrt(0.75),
               .tolerance = tolerance,
               .tolerance_is = tolerance_is,
               .source = "q = sqrt(3)/2 of a fluid of constant viscosity (Borderies et al. 1982; Hahn 2025)",
               .command = command + ", and at q = 0.78"};
  };
  return {
      row("bunching at which collisions carry no momentum", collisional, 0.03, "a ring of particles is no such fluid"),
      row("bunching at which nothing does (transport of the second half orbit)", total, 0.08,
          "the same, and the pattern decays meanwhile")};
}

} // namespace

std::vector<Subject> exact_subjects() {
  return {{"string", "Exact solutions", true, maxwells_string},
          {"transmission-layer", "Exact solutions", true, uniform_layer},
          {"transmission-cylinders", "Exact solutions", true, cylinders},
          {"flux-reversal", "Exact solutions", true, flux_reversal},
          {"gravitational-stress", "Exact solutions", true, gravitational_stress}};
}

} // namespace keeler::validation
