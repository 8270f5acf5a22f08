// The quantity that the colours of a picture show: a number per particle, or the surface density.
#pragma once

#include <keeler/particles/patch.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace keeler::render {

enum class ColourField {
  height,  ///< z of a particle, as shades of one colour without a bar
  size,    ///< radius, m
  speed,   ///< speed relative to the local shear, mm/s
  spin,    ///< inertial spin about the vertical, in units of Ω
  cluster, ///< size of the particle's cluster of touching spheres; 1: isolated
  density  ///< a map of the surface density instead of the view from above, kg/m²
};

/// Returns the names of all fields, in the order of the enumeration.
std::vector<std::string> colour_field_names();

/// Returns the field with a name. Throws UsageError that lists all names.
ColourField colour_field_named(const std::string& name);

/// The ends of a colour bar; values outside have the colour of the nearer end.
struct ColourRange {
  double low = 0.0, high = 0.0;
  bool logarithmic = false;

  /// Returns the position of a value on the bar: 0 at the low end, 1 at the high one; 1/2 if the ends are equal.
  double position(double value) const;
  /// Returns the value at the middle of the bar.
  double middle() const;
};

/// Returns one value per particle; for `density`, one per node of the map. Throws UsageError when the patch does not
/// have the field.
std::vector<double> field_values(const Patch& patch, ColourField field);

/// Returns the surface density (kg/m²) where each particle is, from the map of the box and its images.
std::vector<double> particle_densities(const Patch& patch);

/// Returns the range from the 1st to the 99th percentile, or the full range of sizes and clusters. Precondition:
/// `values` is not empty.
ColourRange colour_range(std::vector<double> values, ColourField field);

/// Returns `count` colours of the bar, from its low to its high end, as red, green and blue from 0 to 255.
std::vector<std::array<std::uint8_t, 3>> bar_colours(std::size_t count);

/// Returns the label of the bar: the quantity and its unit.
std::string label_of(ColourField field);

} // namespace keeler::render
