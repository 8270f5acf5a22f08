#include "encoder.hpp"

#include <keeler/particles/store.hpp>
#include <keeler/render/colour_field.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace keeler::live_view {
namespace {

using render::ColourField;

constexpr float max_uint16 = 65535.0F;
constexpr std::size_t range_samples = 2048;
constexpr double range_step = 0.1; // of the way to the new ends of the colour bar, per frame
constexpr std::size_t table_size = 4096;

struct Span {
  float low, unit; // of a coordinate, and of its numbers
};

Span span_of(const std::vector<float>& values) {
  float low = values.front(), high = values.front();
  for (const float value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return {low, (high - low) / max_uint16};
}

// Returns the value within [0, high]; 0 for NaN, which a state may hold for some steps before its run ends by an error.
float bounded(float value, float high) {
  return value > 0.0F ? std::min(value, high) : 0.0F;
}

// The indices of particles to show: all, or those with ids that are multiples of a number.
void choose(const std::vector<std::uint64_t>& ids, std::vector<std::uint32_t>& chosen) {
  const std::uint64_t every = (ids.size() + max_shown - 1) / max_shown;
  chosen.clear();
  for (std::size_t k = 0; k < ids.size(); ++k)
    if (every == 1 || ids[k] % every == 0)
      chosen.push_back(static_cast<std::uint32_t>(k));
  if (chosen.empty())
    chosen.push_back(0); // ids of another tool may have no such multiples
}

// Calls value(body, state, index) for the colour of each particle.
template<class Value>
void fill_from_bodies(const Particles& particles, const std::vector<std::uint32_t>& chosen,
                      const Frequencies& frequencies, const Rotation& rotation,
                      std::array<std::vector<float>, 3>& places, std::vector<float>& radii, std::vector<float>& values,
                      const Value& value) {
  for (std::size_t j = 0; j < chosen.size(); ++j) {
    const std::size_t k = chosen[j];
    particles.prefetch_after(k);
    const Body& body = particles.bodies[k];
    const State state = state_at(body.elements, frequencies, rotation);
    for (int axis = 0; axis < 3; ++axis)
      places[static_cast<std::size_t>(axis)][j] = static_cast<float>(state.position[axis]);
    radii[j] = static_cast<float>(body.radius);
    values[j] = static_cast<float>(value(body, state, k));
  }
}

} // namespace

void Encoder::Columns::resize(std::size_t count) {
  for (std::vector<float>* column : {&places[0], &places[1], &places[2], &radii, &values})
    column->resize(count);
}

void Encoder::fill(const Simulation& simulation, const Scene& scene) {
  const forces::Boundary boundary = simulation.boundary();
  const Particles& particles = boundary.particles;
  choose(particles.ids, chosen_);
  columns_.resize(chosen_.size());
  const Rotation rotation = boundary.rotation();
  const auto fill_with = [&](const auto& value) {
    fill_from_bodies(particles, chosen_, boundary.frequencies, rotation, columns_.places, columns_.radii,
                     columns_.values, value);
  };
  const double shear = boundary.box.shear, to_mm = 1e3 * scene.planet.orbital_frequency;
  const particles::SpinTurn turn(-boundary.to_epoch);
  if (field_ == ColourField::speed)
    fill_with([&](const Body&, const State& at, std::size_t) {
      return to_mm * (at.velocity + Vec3(0.0, shear * at.position.x(), 0.0)).norm();
    });
  else if (field_ == ColourField::size)
    fill_with([](const Body& body, const State&, std::size_t) { return body.radius; });
  else if (field_ == ColourField::spin)
    fill_with([&](const Body&, const State&, std::size_t k) { return turn.from_epoch(particles.spins[k]).z(); });
  else
    fill_with([](const Body&, const State& at, std::size_t) { return at.position.z(); });
}

void Encoder::fill(const Patch& patch) {
  choose(patch.ids, chosen_);
  columns_.resize(chosen_.size());
  const std::vector<double> values =
      field_ == ColourField::density ? render::particle_densities(patch) : field_values(patch, field_);
  for (std::size_t j = 0; j < chosen_.size(); ++j) {
    const std::size_t k = chosen_[j];
    for (int axis = 0; axis < 3; ++axis)
      columns_.places[static_cast<std::size_t>(axis)][j] = static_cast<float>(patch.positions[k][axis]);
    columns_.radii[j] = static_cast<float>(patch.radii[k]);
    columns_.values[j] = static_cast<float>(values[k]);
  }
}

// Clusters and densities need all particles in Cartesian form.
Frame Encoder::encode(const Simulation& simulation, const Scene& scene) {
  Frame frame;
  if (field_ == ColourField::cluster || field_ == ColourField::density) {
    frame = encode(simulation.patch());
  } else {
    fill(simulation, scene);
    frame = pack(simulation.state().particles.size(), simulation.state().box, simulation.orbits());
  }
  frame.step = simulation.state().step;
  return frame;
}

Frame Encoder::encode(const Patch& patch) {
  assert(patch.size() > 0);
  fill(patch);
  return pack(patch.size(), patch.box, patch.time_orbits);
}

render::ColourRange Encoder::next_range() {
  const std::vector<float>& all = columns_.values;
  std::vector<double> sample;
  if (field_ == ColourField::size || field_ == ColourField::cluster) { // the few extreme values matter
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    sample = {*low, *high};
  } else {
    const std::size_t every = (all.size() + range_samples - 1) / range_samples;
    for (std::size_t k = 0; k < all.size(); k += every)
      sample.push_back(all[k]);
  }
  const render::ColourRange now = colour_range(std::move(sample), field_);
  if (!has_range_ || now.logarithmic) {
    range_ = now;
  } else {
    range_.low += range_step * (now.low - range_.low);
    range_.high += range_step * (now.high - range_.high);
  }
  has_range_ = true;
  return range_;
}

// Looks the colours of equal parts of the bar up in a table: a logarithm per particle would take as long as all else.
void Encoder::pack_colours(const render::ColourRange& range, std::uint8_t* bytes) const {
  std::array<std::uint8_t, table_size> table{};
  const double part = (range.high - range.low) / (table_size - 1);
  for (std::size_t k = 0; k < table_size; ++k)
    table[k] =
        static_cast<std::uint8_t>(std::lround(255.0 * range.position(range.low + static_cast<double>(k) * part)));
  const float low = static_cast<float>(range.low), per_unit = part > 0.0 ? static_cast<float>(1.0 / part) : 0.0F;
  for (std::size_t k = 0; k < columns_.values.size(); ++k) {
    const float index = (columns_.values[k] - low) * per_unit + 0.5F;
    bytes[k] = table[static_cast<std::size_t>(bounded(index, static_cast<float>(table_size - 1)))];
  }
}

Frame Encoder::pack(std::size_t total, const ShearingBox& box, double orbits) {
  const std::size_t count = columns_.radii.size();
  auto data = std::make_shared<std::string>(9 * count, '\0');
  const Span x = span_of(columns_.places[0]), y = span_of(columns_.places[1]), z = span_of(columns_.places[2]);
  const float largest = *std::max_element(columns_.radii.begin(), columns_.radii.end());
  const auto per_unit = [](float unit) { return unit > 0.0F ? 1.0F / unit : 0.0F; };
  const float in_x = per_unit(x.unit), in_y = per_unit(y.unit), in_z = per_unit(z.unit), in_r = max_uint16 / largest;
  std::vector<std::uint16_t>& places = packed_;
  places.resize(4 * count);
  const auto rounded = [](float value) {
    return static_cast<std::uint16_t>(static_cast<int>(bounded(value, max_uint16) + 0.5F));
  };
  for (std::size_t k = 0; k < count; ++k) {
    places[4 * k] = rounded((columns_.places[0][k] - x.low) * in_x);
    places[4 * k + 1] = rounded((columns_.places[1][k] - y.low) * in_y);
    places[4 * k + 2] = rounded((columns_.places[2][k] - z.low) * in_z);
    places[4 * k + 3] = rounded(columns_.radii[k] * in_r);
  }
  std::memcpy(data->data(), places.data(), 8 * count);
  const render::ColourRange range = next_range();
  pack_colours(range, reinterpret_cast<std::uint8_t*>(data->data()) + 8 * count);
  Frame frame;
  frame.about = {{"count", count},
                 {"of", total},
                 {"orbits", orbits},
                 {"box_m", {box.size_x, box.size_y}},
                 {"low_m", {x.low, y.low, z.low}},
                 {"unit_m", {x.unit, y.unit, z.unit, largest / max_uint16}},
                 {"field", render::colour_field_names()[static_cast<std::size_t>(field_)]},
                 {"label", label_of(field_)},
                 {"range", {range.low, range.high}}};
  frame.data = std::move(data);
  frame.orbits = orbits;
  return frame;
}

} // namespace keeler::live_view
