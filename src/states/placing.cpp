#include "placing.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/derived.hpp>
#include <keeler/states/layer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keeler {
namespace {

constexpr int usual_sweeps = 120, sweeps_a_round = 400, most_rounds = 12;

[[noreturn]] void fail_too_dense() {
  throw UsageError(fmt::format("too dense: after {} sweeps particles still overlap; raise "
                               "particles.velocity_dispersion or lower the optical depth",
                               most_rounds * sweeps_a_round));
}

} // namespace

double crowd_volume(const std::vector<double>& radii) {
  if (radii.empty())
    return 0.0;
  double cubes = 0.0, squares_of_cubes = 0.0;
  for (const double r : radii) {
    cubes += r * r * r;
    squares_of_cubes += r * r * r * r * r * r;
  }
  return 4.0 / 3.0 * pi * (cubes - squares_of_cubes / cubes);
}

Placing::Placing(const UniformRequest& request)
    : request_(request), crowd_volume_(crowd_volume(request.radii)), order_(request.radii.size()) {
  const std::vector<double>& radii = request.radii;
  std::iota(order_.begin(), order_.end(), 0u);
  std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return radii[a] > radii[b]; });
  for (std::size_t first = 0, last; first < order_.size(); first = last) {
    const double smallest = 0.5 * radii[order_[first]];
    for (last = first; last < order_.size() && radii[order_[last]] >= smallest;)
      ++last;
    octaves_.push_back({first, last});
  }
  for (std::size_t k = 0; k < request.closed.size(); ++k) {
    const auto& [centre, radius] = request.closed[k];
    const auto number = static_cast<std::uint32_t>(radii.size() + k);
    spheres_.push_back({centre, radius, centre.z(), number, true});
  }
}

void Placing::run(const std::function<void(double)>& progress) {
  const ShearingBox& box = request_.box;
  double work = 0.0, done = 0.0; // an octave's goes with all that are placed so far
  for (const Octave& octave : octaves_)
    work += static_cast<double>(octave.last);
  for (const Octave& octave : octaves_) {
    draw(octave);
    sort_by_place(spheres_, box);
    const double part = static_cast<double>(octave.last) / work;
    int round = 0;
    const auto after_sweep = [&](int sweeps) { // nobody knows how many there will be
      const int all = round * sweeps_a_round + sweeps;
      progress(done + part * all / (all + 0.5 * usual_sweeps));
    };
    while (!separate(spheres_, box, box.first_offset, sweeps_a_round, after_sweep)) {
      if (++round == most_rounds)
        fail_too_dense();
      redraw_caught(round);
    }
    done += part;
    for (Sphere& sphere : spheres_) // nothing pulls it when smaller ones come: they have no room to be pushed to
      sphere.height = sphere.place.z();
  }
}

bool Placing::is_free(const Vec3& place, double radius, const SizeLevels& larger) const {
  bool free = true;
  larger.visit_near(place, radius, 1.0, 0, [&](std::size_t k, const Image& image) {
    const double sum = radius + spheres_[k].radius;
    const Vec3 d = place - spheres_[k].place - request_.box.displacement(image, request_.box.first_offset);
    free = free && d.squaredNorm() >= sum * sum;
  });
  return free;
}

// Evenly, or where the density pattern accepts it (von Neumann's rejection).
std::pair<double, double> Placing::draw_guiding_centre(RandomStream& random) const {
  const DensityPattern& pattern = request_.pattern;
  for (;;) {
    const double x = (random.uniform() - 0.5) * request_.box.size_x, y = (random.uniform() - 0.5) * request_.box.size_y;
    if (pattern.uniform() || random.uniform() * pattern.peak() < pattern.relative(x, y))
      return {x, y};
  }
}

// Tries places until one is free of all that is larger; from time to time farther from the mid-plane.
Vec3 Placing::draw_place(RandomStream random, double radius, const SizeLevels& larger) const {
  constexpr int tries_a_height = 50, most_tries = 1000;
  const Frequencies& f = request_.frequencies;
  const Streamlines& streamlines = request_.streamlines;
  double flat = 0.0, normal = 0.0;
  for (int tries = 0;; ++tries) {
    if (tries % tries_a_height == 0) {
      flat = 2.0 * random.uniform() - 1.0;
      normal = random.normal();
    }
    const auto [guiding_x, guiding_y] = draw_guiding_centre(random);
    const Elements streamline = streamlines.elements(guiding_x);
    const double crowding = request_.pattern.relative(guiding_x, guiding_y) / streamlines.spacing(guiding_x),
                 motion = request_.dispersion_z / f.nu;
    const double height = std::sqrt(motion * motion + request_.own_room * crowding);
    const double filling = crowding * crowd_volume_ / request_.box.area() / (std::sqrt(two_pi) * height);
    const LayerProfile profile = LayerProfile::of_height(height, filling, largest_filling);
    const int heights = tries / tries_a_height; // drawn so far
    const double stretch = 1.0 + heights;
    const Vec3 place(guiding_x - streamline.e_cos, guiding_y + 2.0 / f.kappa * streamline.e_sin,
                     stretch * (profile.slab * flat + profile.sigma * normal));
    if (tries == most_tries || is_free(place, radius, larger))
      return place;
  }
}

void Placing::draw(const Octave& octave) {
  const SizeLevels larger(spheres_, request_.box, request_.box.first_offset);
  std::vector<Sphere> drawn(octave.last - octave.first);
  parallel_for(drawn.size(), [&](std::size_t k) {
    const std::uint32_t particle = order_[octave.first + k];
    drawn[k] = {
        draw_place(RandomStream(request_.seed, RandomPurpose::position, particle), request_.radii[particle], larger),
        request_.radii[particle], 0.0, particle};
  });
  double moment = 0.0, squares = 0.0; // the least change that leaves no mean height by mass
  for (const Sphere& sphere : drawn) {
    moment += sphere.mass() * sphere.place.z();
    squares += sphere.mass() * sphere.mass();
  }
  for (Sphere& sphere : drawn)
    sphere.height = sphere.place.z() -= sphere.mass() * moment / squares;
  spheres_.insert(spheres_.end(), drawn.begin(), drawn.end());
}

// The smaller of a pair that still overlaps is caught, mostly in the wedge between two large ones: it gets another
// place.
void Placing::redraw_caught(int round) {
  const SizeLevels levels(spheres_, request_.box, request_.box.first_offset);
  std::vector<Vec3> places(spheres_.size());
  parallel_for(spheres_.size(), [&](std::size_t k) {
    const Sphere& sphere = spheres_[k];
    bool caught = false;
    places[k] = sphere.place;
    if (sphere.held)
      return;
    levels.visit_near(sphere.place, sphere.radius, 1.0, 0, [&](std::size_t j, const Image& image) {
      const Sphere& other = spheres_[j];
      if (j == k || (!other.held && (other.radius < sphere.radius || (other.radius == sphere.radius && j > k))))
        return;
      const Vec3 d = sphere.place - other.place - request_.box.displacement(image, request_.box.first_offset);
      caught = caught || d.norm() < sphere.radius + other.radius;
    });
    const std::uint64_t stream = static_cast<std::uint64_t>(round) << 32 | sphere.particle;
    if (caught)
      places[k] = draw_place(RandomStream(request_.seed, RandomPurpose::relaxation, stream), sphere.radius, levels);
  });
  for (std::size_t k = 0; k < spheres_.size(); ++k) {
    spheres_[k].place = places[k];
    spheres_[k].height = places[k].z();
  }
}

std::vector<Vec3> Placing::places() const {
  std::vector<Vec3> by_particle(spheres_.size());
  for (const Sphere& sphere : spheres_)
    by_particle[sphere.particle] = sphere.place;
  return by_particle;
}

} // namespace keeler
