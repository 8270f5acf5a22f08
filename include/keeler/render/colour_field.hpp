// What the colours of a picture say: a number of each particle, or the surface density where it stands.
#pragma once

#include <keeler/particles/patch.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

enum class ColourField {
  height,  ///< how high a particle stands, as shades of one colour without a bar
  size,    ///< radius, m
  speed,   ///< of the motion relative to the local shear, mm/s
  spin,    ///< about the vertical, against the stars, in units of Ω
  cluster, ///< members of the cluster of touching spheres that it belongs to; 1: it stands alone
  density  ///< a map of the surface density instead of the view from above, kg/m²
};

/// As above, in this order.
std::vector<std::string> colour_field_names();

/// The field of a name as above. Throws UsageError that lists them.
ColourField colour_field_named(const std::string& name);

/// The ends of a colour bar; what lies outside has the colour of the end.
struct ColourRange {
  double low = 0.0, high = 0.0;
  bool logarithmic = false;

  /// 0 at the low end, 1 at the high one; 1/2 where both are the same.
  double share(double value) const;
  /// Half way in colour.
  double middle() const;
};

/// A value a particle; of `density`, a value a node of the map. Throws UsageError when the patch does not have the
/// field.
std::vector<double> field_values(const Patch& patch, ColourField field);

/// All but the outermost two in a hundred of the values; at least one value.
ColourRange colour_range(std::vector<double> values, ColourField field);

/// The colours of the bar from its low end to its high one: red, green and blue of each, from 0 to 255.
std::vector<std::array<std::uint8_t, 3>> bar_colours(std::size_t count);

/// What stands below the bar: the quantity and its unit.
std::string label_of(ColourField field);

} // namespace keeler
