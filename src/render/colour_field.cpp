#include <keeler/render/colour_field.hpp>

#include "density_map.hpp"
#include "patch_views.hpp"

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/clusters.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace keeler::render {
namespace {

constexpr std::array<std::pair<const char*, ColourField>, 6> fields = {{{"height", ColourField::height},
                                                                        {"size", ColourField::size},
                                                                        {"speed", ColourField::speed},
                                                                        {"spin", ColourField::spin},
                                                                        {"cluster", ColourField::cluster},
                                                                        {"density", ColourField::density}}};

// Returns speeds relative to the mean motion (0, −S x, 0), converted by Ω from rad⁻¹ to s⁻¹.
std::vector<double> speeds(const Patch& patch) {
  std::vector<double> values;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3 relative = patch.velocities[k] + Vec3(0.0, patch.box.shear * patch.positions[k].x(), 0.0);
    values.push_back(1e3 * patch.orbital_frequency * relative.norm());
  }
  return values;
}

std::vector<double> spins(const Patch& patch) {
  if (patch.spins.empty())
    throw UsageError("no colours of spins: the particles of this snapshot are smooth and have none; choose another "
                     "field, or run a scene with collisions.friction");
  std::vector<double> values;
  for (const Vec3& spin : patch.spins)
    values.push_back(spin.z());
  return values;
}

std::vector<double> cluster_sizes(const Patch& patch) {
  std::vector<double> values(patch.size(), 1.0);
  for (const diagnostics::Cluster& cluster : diagnostics::find_clusters(patch))
    for (const std::uint32_t member : cluster.members)
      values[member] = static_cast<double>(cluster.members.size());
  return values;
}

} // namespace

std::vector<std::string> colour_field_names() {
  std::vector<std::string> names;
  for (const auto& field : fields)
    names.emplace_back(field.first);
  return names;
}

ColourField colour_field_named(const std::string& name) {
  for (const auto& [known, field] : fields)
    if (name == known)
      return field;
  throw UsageError(fmt::format("--colour: '{}' is not a field of a picture; choose one of {}", name,
                               fmt::join(colour_field_names(), ", ")));
}

double ColourRange::position(double value) const {
  assert(!logarithmic || low > 0.0);
  if (!(high > low))
    return 0.5;
  return std::clamp(logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low), 0.0,
                    1.0);
}

double ColourRange::middle() const {
  return logarithmic ? std::sqrt(low * high) : 0.5 * (low + high);
}

std::vector<double> field_values(const Patch& patch, ColourField field) {
  switch (field) {
  case ColourField::size:
    return patch.radii;
  case ColourField::speed:
    return speeds(patch);
  case ColourField::spin:
    return spins(patch);
  case ColourField::cluster:
    return cluster_sizes(patch);
  case ColourField::density:
    return DensityMap(patch).inner_values();
  case ColourField::height:
    break;
  }
  std::vector<double> heights;
  for (const Vec3& position : patch.positions)
    heights.push_back(position.z());
  return heights;
}

std::vector<double> particle_densities(const Patch& patch) {
  const DensityMap map(patch);
  std::vector<double> values;
  values.reserve(patch.size());
  for (const Vec3& position : patch.positions) { // or of its image in the box: only guiding centres are inside
    const double columns = std::floor(position.x() / patch.box.size_x + 0.5);
    const double y = position.y() + columns * patch.offset;
    values.push_back(map.at(position.x() - columns * patch.box.size_x,
                            y - patch.box.size_y * std::floor(y / patch.box.size_y + 0.5)));
  }
  return values;
}

ColourRange colour_range(std::vector<double> values, ColourField field) {
  assert(!values.empty());
  const bool whole = field == ColourField::size || field == ColourField::cluster; // the few extreme values matter
  const auto quantile = [&](double fraction) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  const double low = quantile(whole ? 0.0 : 0.01), high = quantile(whole ? 1.0 : 0.99);
  return {low, high, whole};
}

std::vector<std::array<std::uint8_t, 3>> bar_colours(std::size_t count) {
  const auto byte = [](double channel) { return static_cast<std::uint8_t>(std::lround(255.0 * channel)); };
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (std::size_t k = 0; k < count; ++k) {
    const plot::Colour colour = field_colour((static_cast<double>(k) + 0.5) / static_cast<double>(count));
    colours.push_back({byte(colour.r), byte(colour.g), byte(colour.b)});
  }
  return colours;
}

std::string label_of(ColourField field) {
  switch (field) {
  case ColourField::height:
    return "height, m";
  case ColourField::size:
    return "radius, m";
  case ColourField::speed:
    return "speed relative to the shear, mm/s";
  case ColourField::spin:
    return "spin about the vertical, Ω";
  case ColourField::cluster:
    return "members of the cluster";
  case ColourField::density:
    return "surface density, kg/m²";
  }
  return {};
}

} // namespace keeler::render
