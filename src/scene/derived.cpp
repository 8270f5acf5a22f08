#include <keeler/scene/derived.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/gravity/fft.hpp>
#include <keeler/hill/toomre.hpp>
#include <keeler/particles/patch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

// Peak memory of `keeler run` of examples/a-ring-wakes and examples/equilibrium, measured at N = 10⁵ and 4 × 10⁵.
namespace cost {
constexpr double program_bytes = 33e6;  // code, libraries, buffers that do not grow with N
constexpr double drift_bytes = 590.0;   // lines, cells, lists, stamps, what threads note: at most 660 with state
constexpr double tree_node_bytes = 120; // box, mass, centre, quadrupole, links
constexpr double nodes_per_particle = 0.5;
constexpr double mesh_places = 80.0; // the particles in the order of the mesh's tiles
} // namespace cost

double bytes_per_particle(const Scene& scene, std::size_t count) {
  const double state = sizeof(Body) + sizeof(std::uint64_t);
  const double output_copy = 2 * sizeof(Vec3) + 2 * sizeof(double) + sizeof(std::uint64_t); // a Patch
  const double spins = scene.collisions.friction ? 2.0 * sizeof(Vec3) : 0.0;                // in the state and a Patch
  double total = state + spins + output_copy + cost::drift_bytes;
  if (scene.gravity) {
    total += 2 * sizeof(Vec3) + sizeof(double) + sizeof(std::uint64_t); // a GravityProblem and its answer
    const auto solver = chosen_for(count, *scene.gravity).solver;
    if (solver == GravitySettings::Solver::fft || solver == GravitySettings::Solver::mesh)
      total += cost::mesh_places;
    if (solver == GravitySettings::Solver::tree)
      total += cost::nodes_per_particle * cost::tree_node_bytes + 4 * sizeof(double);
    const bool pairwise = solver == GravitySettings::Solver::tree || solver == GravitySettings::Solver::direct;
    if (pairwise && scene.output.stress_every > 0)
      total += cost::mesh_places; // that measures their energy
  }
  return total;
}

// In heights of the layer, above and below: nearly all of 10⁷ particles are within.
constexpr double mesh_scale_heights = 5.0;

// Of the mesh that gravity or the measurement of its energy makes for so many particles in a box of that size.
double mesh_memory(const Scene& scene, std::size_t count, double size_x, double size_y) {
  using Solver = GravitySettings::Solver;
  if (!scene.gravity)
    return 0.0;
  const GravitySettings gravity = chosen_for(count, *scene.gravity);
  if (gravity.solver == Solver::axisymmetric)
    return radial_mesh_bytes(size_x, gravity.shortest_wavelength, threads());
  const bool pairwise = gravity.solver == Solver::tree || gravity.solver == Solver::direct;
  if (pairwise && (scene.output.stress_every == 0 || !has_energy_meter(gravity)))
    return 0.0;
  ShearingBox box;
  box.size_x = size_x;
  box.size_y = size_y;
  const double distance = std::sqrt(size_x * size_y / static_cast<double>(count));
  const double height = layer_height(scene.optical_depth(), crowd_of(scene.particles),
                                     scene.particles.velocity_dispersion, scene.planet.frequencies.nu);
  const double spacing = pairwise ? cheapest_spacing : gravity.mesh_spacing;
  return mesh_bytes(box, spacing * distance, 2.0 * mesh_scale_heights * height, count);
}

// Beside the program itself. Of a patch from a file the mesh is not known before it is made, with a check of its own.
double run_bytes(const Scene& scene, std::size_t count) {
  const double particles = bytes_per_particle(scene, count) * static_cast<double>(count);
  if (scene.start_from || scene.particles.count == 0 || count == 0)
    return particles;
  const double larger = std::sqrt(static_cast<double>(count) / static_cast<double>(scene.particles.count));
  return particles + mesh_memory(scene, count, larger * scene.size_x, larger * scene.size_y);
}

} // namespace

double surface_density_per_depth(const SizeLaw& sizes, double density) {
  return (4.0 / 3.0) * density * sizes.mean_power(3) / sizes.mean_power(2);
}

double critical_wavelength(double surface_density, const PlanetSettings& planet) {
  return critical_wavelength(newton_g_si, surface_density, planet.frequencies.kappa * planet.orbital_frequency);
}

double toomre_q(double surface_density, double dispersion, const PlanetSettings& planet) {
  return toomre_q(newton_g_si, surface_density, planet.frequencies.kappa * planet.orbital_frequency, dispersion);
}

double distance_from_saturn(const PlanetSettings& planet) {
  constexpr double saturn_gm = 3.7931207e16; // m³ s⁻² (Jacobson et al. 2006)
  const double kappa = planet.frequencies.kappa, omega = planet.orbital_frequency;
  return std::cbrt(2.0 * saturn_gm / (omega * omega * (1.0 + kappa * kappa)));
}

double hill_parameter(double density, double distance) {
  return 0.82 * std::cbrt(density / 900.0) * distance / 1e8;
}

Crowd crowd_of(const SizeLaw& sizes, std::size_t count) {
  const double cubes = sizes.mean_power(3);
  double alone = 0.0; // Σ m²/(Σ m)²; continuous laws have many large particles
  if (sizes.listed > 0)
    alone = std::min(1.0, sizes.mean_power(6) / (cubes * cubes * static_cast<double>(count)));
  return {sizes.mean_power(1), cubes * (1.0 - alone) / sizes.mean_power(2)};
}

namespace {

constexpr double own_room = 1.7; // of H² per τ R²

} // namespace

double layer_height(double optical_depth, const Crowd& crowd, double velocity_dispersion, double nu) {
  const double motion = vertical_fraction * velocity_dispersion * crowd.mean_radius / nu;
  return std::sqrt(motion * motion + own_room * optical_depth * crowd.radius * crowd.radius);
}

double midplane_filling(double optical_depth, const Crowd& crowd, double velocity_dispersion, double nu) {
  const double height = layer_height(optical_depth, crowd, velocity_dispersion, nu);
  return (4.0 / 3.0) * optical_depth * crowd.radius / (std::sqrt(two_pi) * height);
}

double dispersion_for_filling(double optical_depth, const Crowd& crowd, double nu, double filling) {
  const double height = (4.0 / 3.0) * optical_depth * crowd.radius / (std::sqrt(two_pi) * filling);
  const double motion2 = height * height - own_room * optical_depth * crowd.radius * crowd.radius;
  return motion2 > 0.0 ? nu * std::sqrt(motion2) / (vertical_fraction * crowd.mean_radius) : 0.0;
}

// With f = a τ / √(m² + b τ): a² τ² − f² b τ − f² m² = 0.
double optical_depth_for_filling(const Crowd& crowd, double velocity_dispersion, double nu, double filling) {
  const double motion = vertical_fraction * velocity_dispersion * crowd.mean_radius / nu;
  const double a = (4.0 / 3.0) * crowd.radius / (std::sqrt(two_pi) * filling);
  const double half = 0.5 * own_room * crowd.radius * crowd.radius;
  return (half + std::sqrt(half * half + a * a * motion * motion)) / (a * a);
}

Derived derive(const Scene& scene) {
  Derived d;
  d.steps = scene.time.end_step;
  d.particles_known = !scene.start_from.has_value();
  if (!d.particles_known)
    return d;
  const ParticleSettings& particles = scene.particles;
  d.particle_count = particles.count;
  d.optical_depth = scene.optical_depth();
  d.surface_density = scene.surface_density();
  d.lambda_cr = critical_wavelength(d.surface_density, scene.planet);
  const double dispersion =
      particles.velocity_dispersion * particles.sizes.mean_power(1) * scene.planet.orbital_frequency;
  d.toomre_q = toomre_q(d.surface_density, dispersion, scene.planet);
  d.hill_parameter = hill_parameter(particles.density, distance_from_saturn(scene.planet));
  d.midplane_filling =
      std::min(largest_filling, midplane_filling(scene.bunched_optical_depth(), crowd_of(particles),
                                                 particles.velocity_dispersion, scene.planet.frequencies.nu));
  d.memory_mb = 1e-6 * (cost::program_bytes + run_bytes(scene, particles.count));
  return d;
}

void require_memory_for(const Scene& scene, std::size_t count) {
  require_memory(run_bytes(scene, count),
                 fmt::format("a run of {} particles", format_number(static_cast<double>(count))),
                 "take fewer, a coarser mesh, or a machine that has more");
}

std::string in_words(const GravitySettings& gravity) {
  using Solver = GravitySettings::Solver;
  switch (gravity.solver) {
  case Solver::direct:
    return "direct sum";
  case Solver::tree:
    return fmt::format("tree, opening angle {:g}", gravity.opening_angle);
  case Solver::mesh:
    return fmt::format("mesh, spacing {:g} mean distances", gravity.mesh_spacing);
  case Solver::axisymmetric:
    return fmt::format("axisymmetric, waves from {:g} m up", gravity.shortest_wavelength);
  default:
    return fmt::format("fft, asked for an rms force error of {:g}", gravity.force_error);
  }
}

} // namespace keeler
