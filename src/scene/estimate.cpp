#include <keeler/scene/estimate.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/axisymmetric.hpp>
#include <keeler/gravity/fft.hpp>
#include <keeler/gravity/near_image_count.hpp>
#include <keeler/scene/derived.hpp>
#include <keeler/scene/grain_piles.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

// Times on the reference machine, one thread, ns. docs/dev/estimate.md says by which command each was measured.
namespace cost {
constexpr double start = 4.0e3, start_depth = 3.5e3; // a particle; the latter for each unit of optical depth
constexpr double start_mixed = 0.4;                  // the share that wide sizes add
constexpr double advance = 5.6;                      // a particle and step
constexpr double lists = 11.0;      // a particle and step: lines and neighbour lists of equal spheres that meet rarely
constexpr double left_list = 230.0; // a particle's contact: new lists, since who is hit leaves its slack
constexpr double contact = 800.0;   // with all searches; in a patch of 10⁴ particles, whose lines stay in the cache
constexpr double kick = 20.0;       // a particle and kick
constexpr double external = 80.0;   // per particle and step, of an external force
constexpr double tree = 273.0, tree_opened = 44.5; // a particle and kick: the latter over the opening angle squared
constexpr double mesh = 75.0, mesh_node = 16.0;    // a particle and kick; a node and kick
constexpr double mesh_cut = 52.0;                  // a particle and kick, for each spacing that the cut spans
constexpr double radial_waves = 70.0, radial_node = 20.0; // a particle and kick; a node and kick
constexpr double tree_image = 0.1;                        // the share of the tree's time that nine images take
constexpr double direct_pair = 0.7, far_images = 40.0;    // a pair and image; a particle and kick
constexpr double far_set_up = 3.5e3;                      // a kick and image: the expansion of all that are farther
constexpr double resting = 2e4;                           // a grain of a pile and kick, where contacts carry kicks
constexpr double row = 12.0, row_itself = 2e4;            // a particle and row; a row
constexpr double stress = 350.0;                          // a particle and measurement of gravity's energy
constexpr double snapshot = 1550.0, checkpoint = 500.0;   // a particle and file
constexpr double closing = 1000.0;                        // a particle: overlaps, hash
constexpr double force_check = 1500.0;                    // a particle; they also take half a per cent of the run
} // namespace cost

constexpr double usual_step = 1e-3;     // orbits, of the scenes that times were measured on
constexpr double clumping_orbits = 0.9; // after which wakes stand
constexpr double min_wavelengths = 0.5; // of λ_cr along a side of a box that wakes can grow in: the fastest at Q = 1
constexpr double aggregates = 1.1;      // the Hill parameter beyond which all hold together
constexpr double most_fast = 3e4, most_slow = 6e4; // contacts a particle and orbit, as packed as particles get

// Lines of particles fall out of one cache after another.
double cache_factor(double count) {
  return std::pow(count / 1e4, 0.12);
}

// Wide sizes fill several levels of cells, each of which searches the finer ones. A single moonlet does not.
double size_spread(const SizeLaw& sizes) {
  const double mean = sizes.mean_power(1);
  return sizes.mean_power(2) / (mean * mean);
}

double start_ns(const Scene& scene) {
  const double mixed = 1.0 + cost::start_mixed * std::min(1.0, (size_spread(scene.particles.sizes) - 1.0) / 0.15);
  return mixed * (cost::start + cost::start_depth * scene.optical_depth());
}

// An automatic step has about a third of a contact a particle (simulation/step_control.hpp), orbits.
double step_in(const Scene& scene, const ContactRates& rates) {
  if (!scene.time.automatic)
    return scene.time.step;
  const double longest = static_cast<double>(TimeSettings::longest) * scene.time.step;
  return std::clamp(0.35 / rates.all(), scene.time.step, longest);
}

double kicks_an_orbit(const Scene& scene) {
  constexpr double in_wakes = 128.0; // of an automatic interval
  return scene.time.automatic ? in_wakes : 1.0 / (scene.time.step * scene.gravity->kick_every);
}

// Contacts of a particle in an orbit; half as many events. Searches see more neighbours, or go through more levels;
// neighbours that stand close are of the finest level. Contacts that follow from others in the same step are dearer.
double contacts_ns(const ContactRates& rates, double dilute, double count, const Scene& scene) {
  const double crowded = 1.0 + 0.17 * std::log(std::max(1.0, rates.fast / dilute));
  const double search = std::max(size_spread(scene.particles.sizes), crowded);
  const double chains = 1.0 + 0.3 * std::log(1.0 + rates.all() * step_in(scene, rates));
  return cost::contact * search * chains * cache_factor(count) * 0.5 * rates.all();
}

// Of an orbit.
double drift_ns(const ContactRates& rates, double dilute, double count, const Scene& scene) {
  const double step = step_in(scene, rates);
  const double contacts = rates.all() * step; // of a particle in a step
  const double spread = size_spread(scene.particles.sizes);
  const double forces = cost::external * static_cast<double>(scene.external_forces.size());
  const double lifetimes = 0.4 + 0.6 * step / usual_step; // lists last for a time, whatever the number of steps
  const double lists = (cost::lists * lifetimes + cost::left_list * std::min(contacts, 0.3)) * spread;
  return (cost::advance + forces + lists) / step + contacts_ns(rates, dilute, count, scene);
}

ShearingBox box_of(const Scene& scene) {
  ShearingBox box;
  box.size_x = scene.size_x;
  box.size_y = scene.size_y;
  return box;
}

// Height of the layer at the start in mean distances of particles in the plane. More than one where the layer is dense,
// or where most particles are small.
double relative_height(const Scene& scene) {
  const ParticleSettings& particles = scene.particles;
  const double distance = std::sqrt(scene.size_x * scene.size_y / static_cast<double>(particles.count));
  return layer_height(scene.optical_depth(), crowd_of(particles), particles.velocity_dispersion,
                      scene.planet.frequencies.nu) /
         distance;
}

// A cell meets more others in a space than in a plane. A tree whose cells are all opened sums pairs.
double tree_ns(const GravitySettings& gravity, double height, double count, double images) {
  const double depth = 1.0 + 0.85 * std::log((1.0 + height) / 1.75);
  const double cells = cost::tree + cost::tree_opened / (gravity.opening_angle * gravity.opening_angle);
  const double by_cells = std::max(1.0, depth) * cells * (1.0 + cost::tree_image * (images / 9.0 - 1.0));
  return std::min(by_cells, cost::tree + cost::direct_pair * count * images);
}

// The spacing of a mesh follows the distances in the plane: a thick layer has many planes.
double mesh_ns(const Scene& scene, const GravitySettings& gravity, double height) {
  constexpr double heights = 6.0, bytes_a_node = 8.0; // of the layer, from the lowest particle to the highest
  const double count = static_cast<double>(scene.particles.count),
               distance = std::sqrt(scene.size_x * scene.size_y / count);
  const double bytes =
      mesh_bytes(box_of(scene), gravity.mesh_spacing * distance, heights * height * distance, scene.particles.count);
  return cost::mesh + cost::mesh_node * bytes / bytes_a_node / count;
}

// Particles stand up to three times the layer's height from the plane; a box that is narrower than that has more rings.
double near_images(const Scene& scene, ImageSettings images) {
  constexpr double highest = 3.0, max_rings = 6.0;
  const ParticleSettings& particles = scene.particles;
  const double height = highest * layer_height(scene.optical_depth(), crowd_of(particles),
                                               particles.velocity_dispersion, scene.planet.frequencies.nu);
  const double halves = std::ceil(2.0 * height / std::min(scene.size_x, scene.size_y));
  if (images.far)
    images.rings = std::max({1, images.rings, static_cast<int>(std::min(halves, max_rings))});
  return static_cast<double>(near_image_count(box_of(scene), images));
}

// Of a particle and kick.
double gravity_ns(const Scene& scene) {
  const SizeLaw& sizes = scene.particles.sizes;
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
           cost::radial_node * radial_mesh_nodes(scene.size_x, gravity.shortest_wavelength) / count;
  default:
    return cost::kick + mesh_ns(scene, gravity, height) +
           cost::mesh_cut * cut_for(gravity.force_error, std::sqrt(sizes.mean_power(6)) / sizes.mean_power(3));
  }
}

// Files of a schedule, beside one at its end and `first` at its beginning.
double files(std::int64_t every, std::int64_t steps, double first) {
  return first + 1.0 + (every > 0 ? std::floor(static_cast<double>(steps - 1) / static_cast<double>(every)) : 0.0);
}

double output_ns(const Scene& scene, double count) {
  const std::int64_t steps = scene.time.end_step;
  const double rows = files(scene.output.series_every, steps, 0.0);
  const bool pairs = scene.gravity && scene.gravity->by_pairs();
  // In a long box the fewest particles are checked, a 25th, each with thousands of images instead of 25.
  const double images = pairs ? near_images(scene, {.rings = 2}) : 0.0;
  const double checks = pairs ? cost::force_check * std::max(1.0, images / 625.0) : 0.0;
  const double stresses = pairs ? cost::stress * files(scene.output.stress_every, steps, 0.0) : 0.0;
  return rows * (cost::row * count + cost::row_itself) + count * stresses +
         count * (cost::snapshot * files(scene.output.snapshot_every, steps, 1.0) +
                  cost::checkpoint * files(scene.output.checkpoint_every, steps, 0.0) + cost::closing + checks);
}

// A pair's cross-section is π (r_i + r_j)²: a particle of any size meets its share of the optical depth.
double met_optical_depth(const Scene& scene) {
  return 0.5 * scene.optical_depth() * (1.0 + 1.0 / size_spread(scene.particles.sizes));
}

double dilute_rate(double optical_depth, double vertical_ratio) {
  return 19.0 * optical_depth * std::pow(vertical_ratio, 0.9);
}

// Impacts happen at about three times the speed r Ω.
double typical_restitution(const Scene& scene) {
  const double speed = crowd_of(scene.particles).radius * scene.planet.orbital_frequency;
  return scene.collisions.restitution({.speed = 3.0 * speed});
}

double saturating(double rate, double most) {
  return rate / (1.0 + rate / most);
}

bool has_room_for_wakes(const Scene& scene) {
  const double wavelength = critical_wavelength(scene.surface_density(), scene.planet);
  return std::min(scene.size_x, scene.size_y) > min_wavelengths * wavelength;
}

} // namespace

double layer_crowding(double optical_depth) {
  return std::pow(optical_depth, 1.8);
}

// Self-gravity presses a layer together: 4π G ρ/Ω² goes with r_h³.
double pressed_crowding(double optical_depth, double hill_parameter) {
  return 247.0 * std::pow(optical_depth, 0.9) * std::pow(std::min(hill_parameter, aggregates), 6);
}

double wake_crowding(double optical_depth, double hill_parameter) {
  const double depth = 2.0 * optical_depth;
  return 2.0 * std::pow(depth, 3) / (1.0 + std::pow(depth, 1.5)) *
         std::exp(12.5 * (std::min(hill_parameter, aggregates) - 0.39));
}

namespace {

// What ν adds to the crowding of a layer that has no gravity of its own. Below an optical depth of one the particles of
// a layer that is pulled flat lie side by side.
double vertical_crowding(double optical_depth, double vertical_ratio) {
  return layer_crowding(optical_depth) * std::min(1.0, std::pow(optical_depth, 3)) *
         (std::pow(vertical_ratio, 2.1) - 1.0);
}

// How much more often than at ν = Ω particles press on each other that have lost their speed: the more, the more of
// them lie on others.
double vertical_press(double optical_depth, double restitution, double vertical_ratio) {
  const double more = std::pow(vertical_ratio, std::min(3.7, 1.7 + 4.0 * restitution)) - 1.0;
  return std::max(0.0, 1.0 + more / (1.0 + more / (50.0 + 5000.0 * std::pow(optical_depth, 9))));
}

} // namespace

// Dilute layers collide 19 τ times an orbit, and more often where they swing faster. Particles that lose their speed
// stay together and collide again, the more often the less they keep and the more crowded they are. Where sizes differ,
// small ones move too fast for slow contacts. Spheres that keep nothing hop at the least rebound (v_cut/1000),
// thousands of times an orbit.
ContactRates contact_rates(double optical_depth, double restitution, double crowding, double spread,
                           double vertical_ratio) {
  const double dilute = dilute_rate(optical_depth, vertical_ratio);
  const double flat = crowding + vertical_crowding(optical_depth, vertical_ratio);
  const double fast = dilute * (1.0 + 4.5 * std::exp(-7.2 * restitution) * flat);
  const double slow = dilute * vertical_press(optical_depth, restitution, vertical_ratio) *
                      (34.0 * std::exp(-13.0 * restitution) * (1.0 / (spread * spread * spread) + crowding / 7.0) +
                       0.12 / (restitution + 7e-5) * std::exp(-30.0 * restitution));
  return {saturating(fast, most_fast), saturating(slow, most_slow)};
}

SceneContacts scene_contacts(const Scene& scene) {
  const double depth = scene.optical_depth(), spread = size_spread(scene.particles.sizes);
  const auto rates = [&](double crowding) {
    return contact_rates(met_optical_depth(scene), typical_restitution(scene), layer_crowding(depth) + crowding, spread,
                         scene.planet.frequencies.nu);
  };
  if (!scene.gravity || !scene.gravity->by_pairs())
    return {rates(0.0), rates(0.0)};
  const double r_h = hill_parameter(scene.particles.density, distance_from_saturn(scene.planet));
  const double pressed = pressed_crowding(depth, r_h);
  return {rates(pressed), rates(has_room_for_wakes(scene) ? std::max(pressed, wake_crowding(depth, r_h)) : pressed)};
}

namespace {

// A grain of a pile and orbit: it rattles from kick to kick, until it rests. Where contacts bounce it never does.
double pile_ns(const Scene& scene, double dilute) {
  constexpr double rattling = 8000.0, bouncing = 30.0; // contacts an orbit; a kick
  if (!scene.gravity)
    return 0.0;
  const double kicks = kicks_an_orbit(scene), count = static_cast<double>(scene.particles.count);
  const bool carries = scene.gravity->carries();
  const ContactRates rates{carries ? rattling : bouncing * kicks, 0.0};
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
          "a box of 1 : {} makes self-gravity about {} times as dear as a square one: a kick sums "
          "{:g} images of it one by one; gravity.solver = \"fft\" does not",
          format_number(longer / shorter, 3), format_number(times, 1), near_images(scene, scene.gravity->images)));
  }
  Scene bouncing = scene;
  bouncing.collisions.restitution = constant_restitution(0.5);
  if (const double times = here.drift / estimate_run(bouncing).drift; times >= much)
    lines.push_back(
        fmt::format("a restitution of {} makes the drift about {} times as dear as one of 0.5: particles that lose "
                    "their speed stay together and meet again and again",
                    format_number(typical_restitution(scene), 2), format_number(times, 1)));
  return lines;
}

RunEstimate estimate_run(const Scene& scene, double pair_ns) {
  const double count = static_cast<double>(scene.particles.count);
  const double orbits = static_cast<double>(scene.time.end_step) * scene.time.step;
  const double smooth = std::min(orbits, clumping_orbits);
  const SceneContacts contacts = scene_contacts(scene);
  const double dilute = dilute_rate(met_optical_depth(scene), scene.planet.frequencies.nu);
  const double scale = 1e-9 * pair_ns / reference_pair_ns;
  RunEstimate estimate;
  estimate.start = scale * start_ns(scene) * count;
  estimate.drift = scale * count *
                   (smooth * drift_ns(contacts.smooth, dilute, count, scene) +
                    (orbits - smooth) * drift_ns(contacts.wakes, dilute, count, scene));
  estimate.drift += scale * GrainPiles(scene).grain_orbits(orbits) * pile_ns(scene, dilute);
  if (scene.gravity)
    estimate.gravity = scale * count * orbits * kicks_an_orbit(scene) * gravity_ns(scene);
  estimate.output = scale * output_ns(scene, count);
  return estimate;
}

} // namespace keeler
