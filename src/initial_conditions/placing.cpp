#include "placing.hpp"

#include "layer.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/layer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace keeler::initial_conditions {
namespace {

constexpr int usual_sweeps = 120, sweeps_per_round = 400, max_rounds = 12;

[[noreturn]] void fail_too_dense() {
  throw UsageError(fmt::format("too dense: after {} sweeps particles still overlap; raise "
                               "particles.velocity_dispersion or lower the optical depth",
                               max_rounds * sweeps_per_round));
}

} // namespace

double crowd_volume(const std::vector<double>& radii, const Communicator& ranks) {
  ExactSum cubes, squares_of_cubes;
  for (const double r : radii) {
    cubes += r * r * r;
    squares_of_cubes += r * r * r * r * r * r;
  }
  ranks.merge({&cubes, &squares_of_cubes});
  const double all = cubes.value();
  return all > 0.0 ? 4.0 / 3.0 * pi * (all - squares_of_cubes.value() / all) : 0.0;
}

Placing::Placing(const UniformRequest& request, const Communicator& ranks)
    : request_(request), slabs_(ranks, request.box), crowd_volume_(crowd_volume(request.radii, ranks)),
      order_(request.radii.size()) {
  find_octaves();
  const std::uint64_t count = octaves_.empty() ? 0 : octaves_.back().placed;
  for (std::size_t k = 0; k < request.closed.size(); ++k) {
    const auto& [centre, radius] = request.closed[k];
    spheres_.push_back({centre, radius, centre.z(), static_cast<std::uint32_t>(count + k), true});
  }
}

void Placing::find_octaves() {
  const std::vector<double>& radii = request_.radii;
  std::iota(order_.begin(), order_.end(), 0u);
  std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return radii[a] > radii[b]; });
  for (std::size_t first = 0, last;; first = last) {
    const double largest = slabs_.ranks().max(first < order_.size() ? radii[order_[first]] : 0.0);
    if (largest == 0.0)
      return;
    for (last = first; last < order_.size() && radii[order_[last]] >= 0.5 * largest;)
      ++last;
    octaves_.push_back({first, last, slabs_.ranks().sum(last)});
  }
}

void Placing::run(const std::function<void(double)>& progress) {
  const ShearingBox& box = request_.box;
  assert(box.area() > 0.0);
  double work = 0.0, done = 0.0; // of an octave: all particles placed so far
  for (const Octave& octave : octaves_)
    work += static_cast<double>(octave.placed);
  for (const Octave& octave : octaves_) {
    draw(octave);
    sort_by_position(spheres_, box);
    const double part = static_cast<double>(octave.placed) / work;
    int round = 0;
    const auto after_sweep = [&](int sweeps) { // the number of sweeps is not known in advance
      const int all = round * sweeps_per_round + sweeps;
      progress(done + part * all / (all + 0.5 * usual_sweeps));
    };
    while (!separate(spheres_, box, box.first_offset, slabs_, sweeps_per_round, after_sweep)) {
      if (++round == max_rounds)
        slabs_.ranks().together(fail_too_dense);
      redraw_overlapping(round);
    }
    done += part;
    for (Sphere& sphere : spheres_) // no tether while smaller ones are placed, which have no room to push it to
      sphere.height = sphere.position.z();
  }
}

bool Placing::is_free(const Trial& trial, const SizeLevels& larger) const {
  bool free = true;
  larger.visit_near(trial.position, trial.radius, 1.0, 0, [&](std::size_t k, const Image& image) {
    const double sum = trial.radius + spheres_[k].radius;
    const Vec3 d = trial.position - spheres_[k].position - request_.box.displacement(image, request_.box.first_offset);
    free = free && d.squaredNorm() >= sum * sum;
  });
  return free;
}

// Draws it uniformly, or from the density pattern by von Neumann's rejection.
std::pair<double, double> Placing::draw_guiding_centre(RandomStream& random) const {
  const scene::DensityPattern& pattern = request_.pattern;
  for (;;) {
    const double x = (random.uniform() - 0.5) * request_.box.size_x, y = (random.uniform() - 0.5) * request_.box.size_y;
    if (pattern.uniform() || random.uniform() * pattern.peak() < pattern.relative(x, y))
      return {x, y};
  }
}

// Tries another position; after every 50 tries at another height, scaled farther from the mid-plane.
void Placing::try_another_position(Trial& trial) const {
  constexpr int tries_per_height = 50;
  const Frequencies& f = request_.frequencies;
  const Streamlines& streamlines = request_.streamlines;
  const int heights = trial.tries / tries_per_height; // drawn before
  if (trial.tries++ % tries_per_height == 0) {
    trial.flat = 2.0 * trial.random.uniform() - 1.0;
    trial.normal = trial.random.normal();
  }
  const auto [guiding_x, guiding_y] = draw_guiding_centre(trial.random);
  const Elements streamline = streamlines.elements(guiding_x);
  const double crowding = request_.pattern.relative(guiding_x, guiding_y) / streamlines.spacing(guiding_x),
               motion = request_.dispersion_z / f.nu;
  const double height = std::sqrt(motion * motion + request_.own_room * crowding);
  const double filling = crowding * crowd_volume_ / request_.box.area() / (std::sqrt(two_pi) * height);
  const LayerProfile profile = LayerProfile::of_height(height, filling, scene::largest_filling);
  const double stretch = 1.0 + heights;
  trial.position = Vec3(guiding_x - streamline.e_cos, guiding_y + 2.0 / f.kappa * streamline.e_sin,
                        stretch * (profile.slab * trial.flat + profile.sigma * trial.normal));
}

// Tries positions for each until one is free of all larger spheres, or the limit of tries is reached. A trial in
// another slab is decided by that slab's rank.
std::vector<Sphere> Placing::place(std::vector<Trial> trials, const SizeLevels& larger) const {
  constexpr int max_tries = 1000;
  std::vector<Sphere> placed;
  placed.reserve(trials.size());
  parallel_for(trials.size(), [&](std::size_t k) { try_another_position(trials[k]); });
  do {
    trials = send_to_owners(std::move(trials));
    parallel_for(trials.size(), [&](std::size_t k) {
      Trial& trial = trials[k];
      while (slabs_.has(trial.position) && trial.tries <= max_tries && !is_free(trial, larger))
        try_another_position(trial);
    });
    const auto elsewhere = std::stable_partition(trials.begin(), trials.end(),
                                                 [&](const Trial& trial) { return slabs_.has(trial.position); });
    for (auto trial = trials.begin(); trial != elsewhere; ++trial)
      placed.push_back({trial->position, trial->radius, trial->position.z(), trial->particle});
    trials.erase(trials.begin(), elsewhere);
  } while (slabs_.ranks().any(!trials.empty()));
  return placed;
}

std::vector<Placing::Trial> Placing::send_to_owners(std::vector<Trial> trials) const {
  const Communicator& ranks = slabs_.ranks();
  if (!ranks.distributed())
    return trials;
  std::vector<std::vector<Trial>> parcels(ranks.size());
  for (const Trial& trial : trials)
    parcels[slabs_.owner(trial.position)].push_back(trial);
  free_memory(trials);
  std::vector<std::vector<Trial>> received = ranks.exchange(parcels);
  free_memory(parcels);
  for (std::vector<Trial>& parcel : received) {
    trials.insert(trials.end(), parcel.begin(), parcel.end());
    free_memory(parcel);
  }
  return trials;
}

void Placing::draw(const Octave& octave) {
  assert(octave.first <= octave.last && octave.last <= order_.size());
  const std::size_t own = spheres_.size();
  slabs_.add_copies(spheres_, 1.0);
  const SizeLevels larger(spheres_, request_.box, request_.box.first_offset);
  std::vector<Trial> trials(octave.last - octave.first);
  parallel_for(trials.size(), [&](std::size_t k) {
    const std::uint32_t number = order_[octave.first + k];
    const std::uint64_t particle = request_.first + number;
    trials[k].random = RandomStream(request_.seed, RandomPurpose::position, particle);
    trials[k].radius = request_.radii[number];
    trials[k].particle = static_cast<std::uint32_t>(particle);
  });
  std::vector<Sphere> drawn = place(std::move(trials), larger);
  spheres_.resize(own);
  ExactSum moment, squares; // smallest change to a mass-weighted mean height of zero
  for (const Sphere& sphere : drawn) {
    moment += sphere.mass() * sphere.position.z();
    squares += sphere.mass() * sphere.mass();
  }
  slabs_.ranks().merge({&moment, &squares});
  const double shift = moment.value() / squares.value();
  for (Sphere& sphere : drawn)
    sphere.height = sphere.position.z() -= sphere.mass() * shift;
  spheres_.insert(spheres_.end(), drawn.begin(), drawn.end());
}

// True for the smaller of a pair that still overlaps, mostly in the wedge between two large ones.
bool Placing::still_overlaps(std::size_t k, const SizeLevels& levels) const {
  const Sphere& sphere = spheres_[k];
  bool overlapping = false;
  levels.visit_near(sphere.position, sphere.radius, 1.0, 0, [&](std::size_t j, const Image& image) {
    const Sphere& other = spheres_[j];
    if (j == k || (!other.held && (other.radius < sphere.radius ||
                                   (other.radius == sphere.radius && other.particle > sphere.particle))))
      return;
    const Vec3 d = sphere.position - other.position - request_.box.displacement(image, request_.box.first_offset);
    overlapping = overlapping || d.norm() < sphere.radius + other.radius;
  });
  return overlapping;
}

// Draws other positions for such spheres.
void Placing::redraw_overlapping(int round) {
  const std::size_t own = spheres_.size();
  slabs_.add_copies(spheres_, 1.0);
  const SizeLevels levels(spheres_, request_.box, request_.box.first_offset);
  std::vector<std::uint8_t> overlapping(own);
  parallel_for(own, [&](std::size_t k) { overlapping[k] = !spheres_[k].held && still_overlaps(k, levels); });
  std::vector<Trial> trials;
  std::vector<Sphere> others;
  for (std::size_t k = 0; k < own; ++k) {
    const Sphere& sphere = spheres_[k];
    if (overlapping[k]) {
      const std::uint64_t stream = static_cast<std::uint64_t>(round) << 32 | sphere.particle;
      trials.push_back(
          {RandomStream(request_.seed, RandomPurpose::relaxation, stream), sphere.radius, sphere.particle});
    } else {
      others.push_back(sphere);
      others.back().height = sphere.position.z();
    }
  }
  const std::vector<Sphere> placed = place(std::move(trials), levels);
  spheres_ = std::move(others);
  spheres_.insert(spheres_.end(), placed.begin(), placed.end());
}

std::vector<Sphere> Placing::take_particles() {
  std::erase_if(spheres_, [](const Sphere& sphere) { return sphere.held; });
  std::sort(spheres_.begin(), spheres_.end(), [](const Sphere& a, const Sphere& b) { return a.particle < b.particle; });
  return std::move(spheres_);
}

} // namespace keeler::initial_conditions
