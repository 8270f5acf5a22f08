#include "encoder.hpp"

#include "particle_lanes.hpp"

#include <keeler/particles/store.hpp>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

namespace keeler::live_view {
namespace {

using render::ColourField;

typedef int FourInts __attribute__((vector_size(16)));

constexpr float max_number = 65535.0F;
constexpr float margin = 0.02F;        // of the extents, so that the next frames fit as well
constexpr std::size_t value_index = 4; // in an Extent
constexpr std::size_t range_samples = 1024;
constexpr double range_step = 0.1; // of the way to the new ends of the colour bar, per frame

Four lesser(Four a, Four b) {
  return a < b ? a : b;
}

Four greater(Four a, Four b) {
  return a > b ? a : b;
}

Four clamped(Four value, float high) { // NaN, which a state may hold before its run ends by an error, becomes 0
  return lesser(greater(value, four(0.0F)), four(high));
}

// Smallest and largest numbers, four particles beside each other.
struct LaneExtent {
  std::array<Four, 5> low, high;

  LaneExtent() {
    low.fill(four(Extent::huge));
    high.fill(four(-Extent::huge));
  }
  void include(std::size_t which, Four value) {
    low[which] = lesser(value, low[which]);
    high[which] = greater(value, high[which]);
  }
  Extent extent() const {
    Extent all;
    for (std::size_t k = 0; k < low.size(); ++k)
      for (int lane = 0; lane < 4; ++lane) {
        all.low[k] = std::min(all.low[k], low[k][lane]);
        all.high[k] = std::max(all.high[k], high[k][lane]);
      }
    return all;
  }
};

struct Loaded {
  Lanes lanes;
  Four value; // of the colour field
};

} // namespace

bool Encoder::whole_range() const { // the few extreme values matter
  return field_ == ColourField::size || field_ == ColourField::cluster;
}

// Chooses all particles, or the particles with ids that are multiples of a number.
void Encoder::choose(const std::vector<std::uint64_t>& ids) {
  const std::uint64_t every = (ids.size() + max_shown - 1) / max_shown;
  if (every == 1 && chosen_.size() == ids.size() && chosen_.back() + 1 == ids.size())
    return;
  chosen_.clear();
  for (std::size_t k = 0; k < ids.size(); ++k)
    if (every == 1 || ids[k] % every == 0)
      chosen_.push_back(static_cast<std::uint32_t>(k));
  if (chosen_.empty())
    chosen_.push_back(0); // ids of another tool may have no such multiples
}

Frame Encoder::encode(const Simulation& simulation, const Scene& scene) {
  if (field_ == ColourField::cluster || field_ == ColourField::density)
    return encode(simulation.patch()); // they need all particles in Cartesian form
  const forces::Boundary boundary = simulation.boundary();
  const Particles& particles = boundary.particles;
  choose(particles.ids);
  const BodyLanes bodies(boundary);
  std::shared_ptr<const std::string> data;
  if (field_ == ColourField::speed) {
    const Four to_mm = four(static_cast<float>(1e3 * scene.planet.orbital_frequency));
    data = pack([&](const FourIndices& at) {
      const Lanes lanes = bodies.read<true>(at);
      return Loaded{lanes, to_mm * lanes.speed};
    });
  } else if (field_ == ColourField::spin && particles.rough) {
    const particles::SpinTurn turn(-boundary.to_epoch);
    data = pack([&](const FourIndices& at) {
      Loaded loaded{bodies.read<false>(at), {}};
      for (int lane = 0; lane < 4; ++lane)
        loaded.value[lane] = static_cast<float>(turn.from_epoch(particles.spins[at.k[lane]]).z());
      return loaded;
    });
  } else {
    const bool by_size = field_ == ColourField::size;
    data = pack([&](const FourIndices& at) {
      const Lanes lanes = bodies.read<false>(at);
      return Loaded{lanes, by_size ? lanes.radius : lanes.z};
    });
  }
  return frame_of(std::move(data), particles.size(), boundary.box, simulation.orbits());
}

Frame Encoder::encode(const Patch& patch) {
  assert(patch.size() > 0);
  choose(patch.ids);
  const std::vector<double> values =
      field_ == ColourField::density ? render::particle_densities(patch) : field_values(patch, field_);
  std::shared_ptr<const std::string> data = pack([&](const FourIndices& at) {
    Loaded loaded{patch_lanes(patch, at), {}};
    for (int lane = 0; lane < 4; ++lane)
      loaded.value[lane] = static_cast<float>(values[at.k[lane]]);
    return loaded;
  });
  return frame_of(std::move(data), patch.size(), patch.box, patch.time_orbits);
}

// Moves the colour bar towards the values of some particles.
template<class Load> void Encoder::follow_values(const Load& load) {
  std::vector<double> sample;
  if (whole_range()) {
    const bool is_known = extent_.low[value_index] <= extent_.high[value_index];
    sample = is_known ? std::vector<double>{extent_.low[value_index], extent_.high[value_index]}
                      : std::vector<double>{1.0, 2.0}; // any: the first pass finds the extent, and is made again
  } else {
    const std::size_t every = (chosen_.size() + range_samples - 1) / range_samples;
    for (std::size_t j = 0; j < chosen_.size(); j += every)
      sample.push_back(load(FourIndices(chosen_, j)).value[0]);
  }
  const render::ColourRange now = colour_range(std::move(sample), field_);
  if (has_range_ && !now.logarithmic) {
    range_.low += range_step * (now.low - range_.low);
    range_.high += range_step * (now.high - range_.high);
  } else {
    range_ = now;
  }
  has_range_ = true;
}

// A logarithm per particle would take longer than all else.
void Encoder::make_table() {
  const double part = (range_.high - range_.low) / static_cast<double>(table_.size() - 1);
  for (std::size_t k = 0; k < table_.size(); ++k)
    table_[k] =
        static_cast<std::uint8_t>(std::lround(255.0 * range_.position(range_.low + static_cast<double>(k) * part)));
}

bool Encoder::fits(const Extent& extent) const {
  for (std::size_t k = 0; k < value_index; ++k)
    if (extent.low[k] < extent_.low[k] || extent.high[k] > extent_.high[k])
      return false;
  return !whole_range() ||
         (extent.low[value_index] == extent_.low[value_index] && extent.high[value_index] == extent_.high[value_index]);
}

void Encoder::fit(const Extent& extent) {
  extent_ = extent;
  for (std::size_t k = 0; k < value_index; ++k) {
    const float room = margin * (extent.high[k] - extent.low[k]);
    extent_.low[k] -= room;
    extent_.high[k] += room;
  }
  extent_.low[3] = 0.0F; // radius
}

// Returns memory of that size, of an earlier frame if no page has it any more.
std::shared_ptr<std::string> Encoder::buffer(std::size_t size) {
  for (std::shared_ptr<std::string>& free : buffers_)
    if (!free || free.use_count() == 1) {
      std::atomic_thread_fence(std::memory_order_acquire); // after the last reader
      if (!free)
        free = std::make_shared<std::string>();
      free->resize(size);
      return free;
    }
  return std::make_shared<std::string>(size, '\0');
}

// Returns the bytes of a frame; `load` gives four particles. Precondition: chosen_ is not empty.
template<class Load> std::shared_ptr<const std::string> Encoder::pack(const Load& load) {
  std::shared_ptr<std::string> data = buffer(9 * chosen_.size());
  follow_values(load);
  const Extent seen = pack_once(load, *data);
  if (!fits(seen)) {
    fit(seen);
    if (whole_range())
      follow_values(load);
    pack_once(load, *data);
  }
  return data;
}

// Writes all particles, and returns their extent: if that does not fit, the bytes are wrong.
template<class Load> Extent Encoder::pack_once(const Load& load, std::string& data) {
  make_table();
  std::array<Four, 5> low, per_unit;
  for (std::size_t k = 0; k < low.size(); ++k) {
    const bool is_value = k == value_index;
    const float from = is_value ? static_cast<float>(range_.low) : extent_.low[k];
    const float to = is_value ? static_cast<float>(range_.high) : extent_.high[k];
    const float steps = is_value ? static_cast<float>(table_.size() - 1) : max_number;
    low[k] = four(from);
    per_unit[k] = four(to > from ? steps / (to - from) : 0.0F);
  }
  LaneExtent seen;
  const auto number = [&](std::size_t k, Four value, float high) {
    seen.include(k, value);
    return __builtin_convertvector(clamped((value - low[k]) * per_unit[k] + four(0.5F), high), FourInts);
  };
  const std::size_t count = chosen_.size();
  char *place = data.data(), *tone = place + 8 * count;
  for (std::size_t j = 0; j < count; j += 4) {
    const auto [lanes, value] = load(FourIndices(chosen_, j));
    const FourInts xy = number(0, lanes.x, max_number) | number(1, lanes.y, max_number) << 16;
    const FourInts zr = number(2, lanes.z, max_number) | number(3, lanes.radius, max_number) << 16;
    const FourInts index = number(value_index, value, static_cast<float>(table_.size() - 1));
    const FourInts words[2] = {__builtin_shufflevector(xy, zr, 0, 4, 1, 5),
                               __builtin_shufflevector(xy, zr, 2, 6, 3, 7)};
    std::uint8_t tones[4];
    for (int lane = 0; lane < 4; ++lane)
      tones[lane] = table_[static_cast<std::size_t>(index[lane])];
    const std::size_t whole = std::min<std::size_t>(4, count - j);
    if (whole == 4) {
      std::memcpy(place, words, sizeof words);
      std::memcpy(tone, tones, sizeof tones);
    } else {
      std::memcpy(place, words, 8 * whole);
      std::memcpy(tone, tones, whole);
    }
    place += 8 * whole;
    tone += whole;
  }
  return seen.extent();
}

Frame Encoder::frame_of(std::shared_ptr<const std::string> data, std::size_t total, const ShearingBox& box,
                        double orbits) const {
  std::array<float, 4> unit{};
  for (std::size_t k = 0; k < unit.size(); ++k)
    unit[k] = (extent_.high[k] - extent_.low[k]) / max_number;
  return {.about = {{"count", chosen_.size()},
                    {"of", total},
                    {"orbits", orbits},
                    {"box_m", {box.size_x, box.size_y}},
                    {"low_m", {extent_.low[0], extent_.low[1], extent_.low[2]}},
                    {"unit_m", unit},
                    {"field", render::colour_field_names()[static_cast<std::size_t>(field_)]},
                    {"label", label_of(field_)},
                    {"range", {range_.low, range_.high}}},
          .data = std::move(data)};
}

} // namespace keeler::live_view
