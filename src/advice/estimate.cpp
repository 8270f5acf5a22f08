#include <keeler/advice/estimate.hpp>

#include <keeler/advice/grain_piles.hpp>
#include <keeler/core/format.hpp>
#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/gravity/fft.hpp>
#include <keeler/gravity/near_image_count.hpp>
#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/layer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::advice {
namespace {

// Times on the reference machine, one thread, ns. docs/dev/estimate.md gives the command that measured each. "Particle
// and step" means: per particle and step.
namespace cost {
constexpr double start = 4.0e3, start_depth = 3.5e3; // particle; the second per unit of optical depth
constexpr double start_mixed = 0.4;                  // fraction that wide size distributions add
constexpr double advance = 5.6;                      // particle and step
constexpr double lists = 11.0;      // particle and step: lines and neighbour lists of equal spheres with few contacts
constexpr double left_list = 230.0; // contact of a particle: new lists, since it leaves its skin
constexpr double contact = 800.0;   // contact, with all searches; of 10⁴ particles: their lines stay in the cache
constexpr double kick = 20.0;       // particle and kick
constexpr double external = 80.0;   // particle, step and external force
constexpr double tree = 273.0, tree_opened = 44.5; // particle and kick; the second over the squared opening angle
constexpr double mesh = 75.0, mesh_node = 16.0;    // particle and kick; node and kick
constexpr double mesh_cut = 52.0;                  // particle, kick and mesh spacing in the cut-off
constexpr double radial_waves = 70.0, radial_node = 20.0; // particle and kick; node and kick
constexpr double tree_image = 0.1;                        // fraction of the tree's time that nine images take
constexpr double direct_pair = 0.7, far_images = 40.0;    // pair and image; particle and kick
constexpr double far_set_up = 3.5e3;                      // kick and image: the expansion of all farther images
constexpr double resting = 2e4;                           // grain of a pile and kick, if contacts carry kicks
constexpr double row = 12.0, row_itself = 2e4;            // particle and row; row
constexpr double stress = 350.0;                          // particle and measurement of gravity's energy
constexpr double snapshot = 1550.0, checkpoint = 500.0;   // particle and file
constexpr double closing = 1000.0;                        // particle: overlaps, hash
constexpr double check_pair = 0.19;                       // pair; checks also take half a per cent of the run
} // namespace cost

constexpr double usual_step = 1e-3;     // orbits, of the scenes that were measured
constexpr double clumping_orbits = 0.9; // time until wakes form

// The lines of many particles do not fit the caches.
double cache_factor(double count) {
  return std::pow(count / 1e4, 0.12);
}

double start_ns(const Scene& scene) {
  const double mixed =
      1.0 + cost::start_mixed * std::min(1.0, (scene::size_spread(scene.particles.sizes) - 1.0) / 0.15);
  return mixed * (cost::start + cost::start_depth * scene.optical_depth());
}

// Returns the step in orbits. An automatic step has about a third of a contact per particle
// (simulation/step_control.hpp).
double step_at(const Scene& scene, const scene::ContactRates& rates) {
  if (!scene.time.automatic)
    return scene.time.step;
  const double longest = static_cast<double>(scene::TimeSettings::longest) * scene.time.step;
  return std::clamp(0.35 / rates.all(), scene.time.step, longest);
}

double kicks_per_orbit(const Scene& scene) {
  constexpr double in_wakes = 128.0; // with an automatic step
  return scene.time.automatic ? in_wakes : 1.0 / (scene.time.step * scene.gravity->kick_every);
}

// Returns ns per particle and orbit for contacts; a contact of two particles is one event. Crowding adds neighbours to
// searches, a wide size distribution adds levels of cells; crowded neighbours are of the finest level. Contacts that
// follow from others in the same step cost more.
double contacts_ns(const scene::ContactRates& rates, double dilute, double count, const Scene& scene) {
  const double crowded = 1.0 + 0.17 * std::log(std::max(1.0, rates.fast / dilute));
  const double search = std::max(scene::size_spread(scene.particles.sizes), crowded);
  const double chains = 1.0 + 0.3 * std::log(1.0 + rates.all() * step_at(scene, rates));
  return cost::contact * search * chains * cache_factor(count) * 0.5 * rates.all();
}

// Returns ns per particle and orbit.
double drift_ns(const scene::ContactRates& rates, double dilute, double count, const Scene& scene) {
  const double step = step_at(scene, rates);
  const double contacts = rates.all() * step; // per particle and step
  const double spread = scene::size_spread(scene.particles.sizes);
  const double forces = cost::external * static_cast<double>(scene.external_forces.size());
  const double lifetimes = 0.4 + 0.6 * step / usual_step; // the lifetime of lists is a time, not a number of steps
  const double lists = (cost::lists * lifetimes + cost::left_list * std::min(contacts, 0.3)) * spread;
  return (cost::advance + forces + lists) / step + contacts_ns(rates, dilute, count, scene);
}

ShearingBox box_of(const Scene& scene) {
  ShearingBox box;
  box.size_x = scene.size_x;
  box.size_y = scene.size_y;
  return box;
}

// Returns the height of the layer at the start over the mean distance of particles in the plane. It exceeds one in
// dense layers, and where most particles are small.
double relative_height(const Scene& scene) {
  const scene::ParticleSettings& particles = scene.particles;
  const double distance = std::sqrt(scene.size_x * scene.size_y / static_cast<double>(particles.count));
  return layer_height(scene.optical_depth(), particles.layer_sizes(), particles.velocity_dispersion,
                      scene.planet.frequencies.nu) /
         distance;
}

// A cell interacts with more cells in a thick layer than in a plane. A tree with all cells opened sums pairs.
double tree_ns(const GravitySettings& gravity, double height, double count, double images) {
  assert(gravity.opening_angle > 0.0);
  const double depth = 1.0 + 0.85 * std::log((1.0 + height) / 1.75);
  const double cells = cost::tree + cost::tree_opened / (gravity.opening_angle * gravity.opening_angle);
  const double by_cells = std::max(1.0, depth) * cells * (1.0 + cost::tree_image * (images / 9.0 - 1.0));
  return std::min(by_cells, cost::tree + cost::direct_pair * count * images);
}

// The mesh spacing follows the distances in the plane: a thick layer has many mesh planes.
double mesh_ns(const Scene& scene, const GravitySettings& gravity, double height) {
  constexpr double heights = 6.0; // scale heights from the lowest particle to the highest
  const double count = static_cast<double>(scene.particles.count),
               distance = std::sqrt(scene.size_x * scene.size_y / count);
  const gravity::MeshSize size = gravity::mesh_size(box_of(scene), gravity.mesh_spacing * distance,
                                                    heights * height * distance, scene.particles.count);
  return cost::mesh + cost::mesh_node * (size.nodes + size.cells) / count;
}

// Particles reach three scale heights from the mid-plane; a box narrower than that needs more rings of images.
double near_images(const Scene& scene, gravity::ImageSettings images) {
  constexpr double highest = 3.0, max_rings = 6.0;
  const scene::ParticleSettings& particles = scene.particles;
  const double height = highest * layer_height(scene.optical_depth(), particles.layer_sizes(),
                                               particles.velocity_dispersion, scene.planet.frequencies.nu);
  const double halves = std::ceil(2.0 * height / std::min(scene.size_x, scene.size_y));
  if (images.far)
    images.rings = std::max({1, images.rings, static_cast<int>(std::min(halves, max_rings))});
  return static_cast<double>(near_image_count(box_of(scene), images));
}

// Returns ns per particle and kick.
double gravity_ns(const Scene& scene) {
  const particles::SizeLaw& sizes = scene.particles.sizes;
  const double count = static_cast<double>(scene.particles.count);
  const GravitySettings gravity = chosen_for(scene.particles.count, *scene.gravity);
  const double height = relative_height(scene), images = near_images(scene, gravity.images);
  switch (gravity.solver) {
  case GravitySettings::Solver::direct:
    return cost::kick + cost::direct_pair * count * images +
           (gravity.images.far ? cost::far_images + cost::far_set_up * images / count : 0.0);
  case GravitySettings::Solver::tree:
    return cost::kick + tree_ns(gravity, height, count, images);
  case GravitySettings::Solver::mesh:
    return cost::kick + mesh_ns(scene, gravity, height);
  case GravitySettings::Solver::axisymmetric:
    return cost::kick + cost::radial_waves +
           cost::radial_node * gravity::radial_mesh_nodes(scene.size_x, gravity.shortest_wavelength) / count;
  default:
    return cost::kick + mesh_ns(scene, gravity, height) +
           cost::mesh_cut * gravity::cut_for(gravity.force_error, std::sqrt(sizes.mean_power(6)) / sizes.mean_power(3));
  }
}

// Returns the number of files of a schedule, with one at its end and `first` at its beginning.
double files(std::int64_t every, std::int64_t steps, double first) {
  assert(every >= 0 && steps >= 0);
  return first + 1.0 + (every > 0 ? std::floor(static_cast<double>(steps - 1) / static_cast<double>(every)) : 0.0);
}

double output_ns(const Scene& scene, double count) {
  const std::int64_t steps = scene.time.end_step;
  const double rows = files(scene.output.series_every, steps, 0.0);
  const bool pairs = scene.gravity && scene.gravity->by_pairs();
  const double images = pairs ? near_images(scene, {.rings = 1}) : 0.0;
  const double checks = pairs ? cost::check_pair * images * std::clamp(128.0 * 25.0 / images, 8.0, 128.0) : 0.0;
  const double stresses = pairs ? cost::stress * files(scene.output.stress_every, steps, 0.0) : 0.0;
  return rows * (cost::row * count + cost::row_itself) + count * stresses +
         count * (cost::snapshot * files(scene.output.snapshot_every, steps, 1.0) +
                  cost::checkpoint * files(scene.output.checkpoint_every, steps, 0.0) + cost::closing + checks);
}

// Returns ns per grain of a pile and orbit: it rattles between kicks until it rests. If contacts bounce it never rests.
double pile_ns(const Scene& scene, double dilute) {
  constexpr double rattling = 8000.0, bouncing = 30.0; // contacts per orbit; per kick
  if (!scene.gravity)
    return 0.0;
  const double kicks = kicks_per_orbit(scene), count = static_cast<double>(scene.particles.count);
  const bool carries = scene.gravity->carries();
  const scene::ContactRates rates{carries ? rattling : bouncing * kicks, 0.0};
  return contacts_ns(rates, dilute, count, scene) + (carries ? cost::resting * kicks : 0.0);
}

} // namespace

std::array<RunEstimate::Part, 4> RunEstimate::parts() const {
  return {{{"start", start}, {"drift", drift}, {"gravity", gravity}, {"output", output}}};
}

const char* RunEstimate::dominating() const {
  const auto all = parts();
  return std::max_element(all.begin(), all.end(), [](const Part& a, const Part& b) { return a.seconds < b.seconds; })
      ->name;
}

std::vector<std::string> expensive_settings(const Scene& scene) {
  constexpr double much = 5.0;
  const RunEstimate here = estimate_run(scene);
  std::vector<std::string> lines;
  const bool tree =
      scene.gravity && chosen_for(scene.particles.count, *scene.gravity).solver == GravitySettings::Solver::tree;
  if (tree) {
    Scene square = scene;
    square.size_x = square.size_y = std::sqrt(scene.size_x * scene.size_y);
    const auto [shorter, longer] = std::minmax(scene.size_x, scene.size_y);
    if (const double times = here.gravity / estimate_run(square).gravity; times >= much)
      lines.push_back(fmt::format(
          "self-gravity costs about {1} times more in this box of 1 : {0} than in a square one: each kick sums "
          "{2:g} images one by one; use gravity.solver = \"fft\"",
          format_number(longer / shorter, 3), format_number(times, 1), near_images(scene, scene.gravity->images)));
  }
  Scene bouncing = scene;
  bouncing.collisions.restitution = collision::constant_restitution(0.5);
  if (const double times = here.drift / estimate_run(bouncing).drift; times >= much)
    lines.push_back(
        fmt::format("a restitution of {} makes the drift cost about {} times more than one of 0.5: particles that lose "
                    "their speed stay together and collide repeatedly",
                    format_number(typical_restitution(scene), 2), format_number(times, 1)));
  return lines;
}

RunEstimate estimate_run(const Scene& scene, double pair_ns) {
  assert(!scene.start_from && scene.particles.count > 0);
  assert(pair_ns > 0.0);
  const double count = static_cast<double>(scene.particles.count);
  const double orbits = static_cast<double>(scene.time.end_step) * scene.time.step;
  const double smooth = std::min(orbits, clumping_orbits);
  const scene::SceneContacts contacts = scene_contacts(scene);
  const double dilute = scene::dilute_rate(encountered_optical_depth(scene), scene.planet.frequencies.nu);
  const double scale = 1e-9 * pair_ns / reference_pair_ns;
  RunEstimate estimate;
  estimate.start = scale * start_ns(scene) * count;
  estimate.drift = scale * count *
                   (smooth * drift_ns(contacts.smooth, dilute, count, scene) +
                    (orbits - smooth) * drift_ns(contacts.wakes, dilute, count, scene));
  estimate.drift += scale * GrainPiles(scene).grain_orbits(orbits) * pile_ns(scene, dilute);
  if (scene.gravity)
    estimate.gravity = scale * count * orbits * kicks_per_orbit(scene) * gravity_ns(scene);
  estimate.output = scale * output_ns(scene, count);
  return estimate;
}

} // namespace keeler::advice
