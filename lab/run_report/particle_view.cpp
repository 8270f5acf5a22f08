#include "particle_view.hpp"

#include <keeler/core/error.hpp>
#include <keeler/report/html.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace keeler::run_report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double max_uint16 = 65535.0;
constexpr std::size_t bar_colour_count = 256;

// The view reads little-endian numbers.
template<class T> std::string base64_of(const std::vector<T>& values) {
  return report::base64(std::as_bytes(std::span(values)));
}

// Returns `count` of the values, evenly spaced.
template<class T> std::vector<T> thinned(const std::vector<T>& values, std::size_t count) {
  assert(count <= values.size());
  std::vector<T> some;
  some.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    some.push_back(values[k * values.size() / count]);
  return some;
}

// The bounding box of all snapshots, divided into 2¹⁶ − 1 units along each axis.
struct Grid {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);

  void include(const std::vector<Vec3>& positions) {
    for (const Vec3& position : positions) {
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
    }
  }
  double unit(int axis) const { return (high[axis] - low[axis]) / max_uint16; }
  // Returns the positions in grid units: all x, then all y, then all z.
  std::vector<std::uint16_t> encode(const std::vector<Vec3>& positions) const {
    std::vector<std::uint16_t> numbers;
    numbers.reserve(3 * positions.size());
    for (int axis = 0; axis < 3; ++axis)
      for (const Vec3& position : positions)
        numbers.push_back(
            static_cast<std::uint16_t>(unit(axis) > 0.0 ? std::lround((position[axis] - low[axis]) / unit(axis)) : 0));
    return numbers;
  }
};

std::vector<std::uint8_t> colour_indices(const std::vector<double>& values, const render::ColourRange& range) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size());
  for (const double value : values)
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0 * range.position(value))));
  return bytes;
}

bool all_equal(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end();
}

Json numbers_of_range(const render::ColourRange& range) {
  return {{"low", range.low}, {"middle", range.middle()}, {"high", range.high}};
}

} // namespace

// Heights follow from the positions and sizes do not change, so neither is stored per snapshot.
void ParticleView::choose_fields(const Patch& patch) {
  fields_ = {{"speed", render::ColourField::speed, {}}, {"cluster", render::ColourField::cluster, {}}};
  if (!patch.spins.empty())
    fields_.push_back({"spin", render::ColourField::spin, {}});
}

void ParticleView::add(const Patch& patch, const std::string& file) {
  const std::size_t count = std::min(patch.size(), max_particles_);
  const bool first = snapshots_.empty();
  if (first) {
    total_ = patch.size();
    size_x_ = patch.box.size_x;
    size_y_ = patch.box.size_y;
    radii_ = thinned(patch.radii, count);
    choose_fields(patch);
  } else if (patch.size() != total_) {
    throw IoError(fmt::format("'{}' has {} particles and the run's first snapshot {}; they are of different runs", file,
                              patch.size(), total_));
  }
  Shown shown{file, patch.time_orbits, thinned(patch.positions, count), {}};
  for (Field& f : fields_) {
    const std::vector<double> values = field_values(patch, f.field);
    const render::ColourRange range = colour_range(values, f.field);
    f.range = first ? range
                    : render::ColourRange{std::min(f.range.low, range.low), std::max(f.range.high, range.high),
                                          range.logarithmic};
    shown.values.push_back(thinned(values, count));
  }
  snapshots_.push_back(std::move(shown));
}

Json ParticleView::fields() const {
  Json all = Json::array();
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const Field& f = fields_[k];
    Json field = {{"name", f.name}, {"label", label_of(f.field)}, {"range", numbers_of_range(f.range)}};
    for (const Shown& shown : snapshots_)
      field["bytes"].push_back(base64_of(colour_indices(shown.values[k], f.range)));
    all.push_back(field);
  }
  if (!all_equal(radii_)) {
    const render::ColourRange range = colour_range(radii_, render::ColourField::size);
    all.push_back({{"name", "size"},
                   {"label", label_of(render::ColourField::size)},
                   {"range", numbers_of_range(range)},
                   {"bytes", {base64_of(colour_indices(radii_, range))}}});
  }
  return all;
}

Json ParticleView::json() const {
  assert(!snapshots_.empty());
  Grid grid;
  for (const Shown& shown : snapshots_)
    grid.include(shown.positions);
  Json json;
  json["count"] = radii_.size();
  json["of"] = total_;
  json["box_m"] = {size_x_, size_y_};
  json["low_m"] = {grid.low.x(), grid.low.y(), grid.low.z()};
  json["unit_m"] = {grid.unit(0), grid.unit(1), grid.unit(2)};
  json["radii"] = base64_of(std::vector<float>(radii_.begin(), radii_.end()));
  json["colours"] = base64_of(render::bar_colours(bar_colour_count));
  json["height_label"] = label_of(render::ColourField::height);
  json["fields"] = fields();
  for (const Shown& shown : snapshots_)
    json["snapshots"].push_back({{"file", shown.file},
                                 {"time_orbits", shown.time_orbits},
                                 {"places", base64_of(grid.encode(shown.positions))}});
  return json;
}

} // namespace keeler::run_report
