#include <keeler/advice/derived.hpp>
#include <keeler/scene/layer.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/gravity/fft.hpp>
#include <keeler/particles/patch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::advice {
namespace {

// Peak memory of `keeler run` of examples/a-ring-wakes, settled and fresh, and examples/equilibrium at τ 0.5
// to 3, N = 10⁵ to 10⁶.
namespace cost {
constexpr double program_bytes = 33e6;  // code, libraries, buffers that do not grow with N
constexpr double drift_bytes = 440.0;   // lines, cells, lists, event counts, buffers, and gaps of the heap
constexpr double dense_bytes = 250.0;   // longer lists and more pairs, for each optical depth above 1
constexpr double path_bytes = 17e3;     // the same for long steps: for each optical depth and orbit of a step
constexpr double tree_node_bytes = 120; // box, mass, centre, quadrupole, links
constexpr double nodes_per_particle = 0.5;
// on several ranks each has copies of the particles of all, and the sources or the tree made of them
constexpr double gathered_sources_bytes = 90.0, gathered_tree_bytes = 210.0;
constexpr double tiled_bytes = 80.0; // copies of the particles in the order of the mesh's tiles
} // namespace cost

using Solver = GravitySettings::Solver;

// The numbers of particles: of this process, and of all ranks.
struct Counts {
  std::size_t own, all;

  bool are_divided() const { return own < all; }
};

bool is_pairwise(Solver solver) {
  return solver == Solver::tree || solver == Solver::direct;
}

// Returns the bytes of what grows with the neighbours of a particle. Those of a patch from a file are unknown here.
double neighbour_bytes(const Scene& scene) {
  if (scene.particles.count == 0)
    return 0.0;
  const double depth = scene.optical_depth(), step = scene.time.automatic ? 0.0 : scene.time.step;
  return cost::dense_bytes * std::max(0.0, depth - 1.0) + cost::path_bytes * depth * step;
}

// Returns the bytes of the state, the drift and the solver. Without what a solver gathers.
double bytes_per_particle(const Scene& scene, const Counts& counts) {
  const double state = sizeof(Body) + sizeof(std::uint64_t);
  const double spins = scene.collisions.friction ? sizeof(Vec3) : 0.0;
  double total = state + spins + cost::drift_bytes + neighbour_bytes(scene);
  if (scene.gravity) {
    total += 2 * sizeof(Vec3) + sizeof(double) + sizeof(std::uint64_t); // a GravityProblem and its result
    const Solver solver = chosen_for(counts.all, *scene.gravity).solver;
    if (solver == Solver::fft || solver == Solver::mesh)
      total += cost::tiled_bytes;
    if (solver == Solver::tree && !counts.are_divided())
      total += cost::nodes_per_particle * cost::tree_node_bytes + 4 * sizeof(double);
    if (is_pairwise(solver) && scene.output.stress_every > 0)
      total += cost::tiled_bytes; // the mesh that measures their energy
  }
  return total;
}

// Scale heights on each side of the mid-plane that hold nearly all of 10⁷ particles.
constexpr double mesh_scale_heights = 5.0;

// Returns the bytes of the mesh that gravity, or the measurement of its energy, makes for `count` particles in a box.
double mesh_memory(const Scene& scene, const GravitySettings& gravity, std::size_t count, double size_x,
                   double size_y) {
  assert(count > 0 && size_x > 0.0 && size_y > 0.0);
  if (gravity.solver == Solver::axisymmetric)
    return gravity::radial_mesh_bytes(size_x, gravity.shortest_wavelength, threads());
  const bool pairwise = is_pairwise(gravity.solver);
  if (pairwise && (scene.output.stress_every == 0 || !has_energy_meter(gravity)))
    return 0.0;
  ShearingBox box;
  box.size_x = size_x;
  box.size_y = size_y;
  const double distance = std::sqrt(size_x * size_y / static_cast<double>(count));
  const double height = layer_height(scene.optical_depth(), scene.particles.layer_sizes(),
                                     scene.particles.velocity_dispersion, scene.planet.frequencies.nu);
  const double spacing = pairwise ? gravity::cheapest_spacing : gravity.mesh_spacing;
  return gravity::max_mesh_bytes(box, spacing * distance, 2.0 * mesh_scale_heights * height, count);
}

// Returns the bytes of the copies that a solver of many ranks makes of all particles.
double gathered_memory(const GravitySettings& gravity, const Counts& counts) {
  if (!counts.are_divided() || !is_pairwise(gravity.solver))
    return 0.0;
  const bool has_tree = gravity.solver == Solver::tree;
  return (has_tree ? cost::gathered_tree_bytes : cost::gathered_sources_bytes) * static_cast<double>(counts.all);
}

// Returns the bytes of a run without the program. The mesh of a patch from a file is unknown here; the solver checks
// it.
double run_bytes(const Scene& scene, const Counts& counts) {
  double bytes = bytes_per_particle(scene, counts) * static_cast<double>(counts.own);
  if (!scene.gravity)
    return bytes;
  const GravitySettings gravity = chosen_for(counts.all, *scene.gravity);
  bytes += gathered_memory(gravity, counts);
  // each rank has the whole mesh of `axisymmetric`, and its part of the others
  const std::size_t meshed = gravity.solver == Solver::axisymmetric ? counts.all : counts.own;
  if (scene.start_from || scene.particles.count == 0 || meshed == 0)
    return bytes;
  const double factor = std::sqrt(static_cast<double>(meshed) / static_cast<double>(scene.particles.count));
  const double copies = meshed < counts.all ? 2.0 : 1.0; // ranks may hold all of their waves beside the mesh
  return bytes + copies * mesh_memory(scene, gravity, meshed, factor * scene.size_x, factor * scene.size_y);
}

} // namespace

Derived derive(const Scene& scene) {
  Derived d;
  d.steps = scene.time.end_step;
  d.particles_known = !scene.start_from.has_value();
  if (!d.particles_known)
    return d;
  const scene::ParticleSettings& particles = scene.particles;
  d.particle_count = particles.count;
  d.optical_depth = scene.optical_depth();
  d.surface_density = scene.surface_density();
  d.lambda_cr = critical_wavelength(d.surface_density, scene.planet);
  const double dispersion =
      particles.velocity_dispersion * particles.sizes.mean_power(1) * scene.planet.orbital_frequency;
  d.toomre_q = toomre_q(d.surface_density, dispersion, scene.planet);
  d.hill_parameter = scene::hill_parameter(particles.density, distance_from_saturn(scene.planet));
  d.midplane_filling =
      std::min(scene::largest_filling, midplane_filling(scene.bunched_optical_depth(), particles.layer_sizes(),
                                                        particles.velocity_dispersion, scene.planet.frequencies.nu));
  d.memory_mb = 1e-6 * (cost::program_bytes + run_bytes(scene, {particles.count, particles.count}));
  return d;
}

double rank_memory(const Scene& scene, std::size_t own, std::size_t all) {
  assert(own <= all);
  return run_bytes(scene, {own, all});
}

void require_memory_for(const Scene& scene, std::size_t own, std::size_t all) {
  const std::string part =
      own < all ? fmt::format(" on a rank that owns {}", format_number(static_cast<double>(own))) : "";
  require_memory(rank_memory(scene, own, all),
                 fmt::format("a run of {} particles{}", format_number(static_cast<double>(all)), part),
                 "take fewer particles, a coarser mesh, or a machine with more memory");
}

std::string in_words(const GravitySettings& gravity) {
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
    return fmt::format("fft, requested rms force error {:g}", gravity.force_error);
  }
}

} // namespace keeler::advice
