#include "patch_views.hpp"

#include "density_map.hpp"
#include "images.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace keeler {
namespace {

// Ring particles: umber in the depth, ivory in front.
constexpr std::array<Colour, 4> ring_colours = {Colour{0.36, 0.25, 0.18}, Colour{0.70, 0.53, 0.37},
                                                Colour{0.93, 0.80, 0.62}, Colour{1.0, 0.96, 0.88}};
// Violet over green to yellow, evenly brighter, also in grey and to the colour-blind.
constexpr std::array<Colour, 5> field_colours = {Colour{0.27, 0.23, 0.52}, Colour{0.16, 0.45, 0.56},
                                                 Colour{0.13, 0.66, 0.52}, Colour{0.48, 0.82, 0.32},
                                                 Colour{0.99, 0.91, 0.14}};

// A particle, or an image of one, that shows in the frame.
struct Shown {
  Vec3 position;
  double radius;
  std::uint64_t id;
  double share; // of the range of colours
  double toward_viewer = 0.0;
};

// Everything that reaches into the cell, images included.
std::vector<Shown> visible(const Patch& patch, ColourField field, const PictureScale& scale) {
  const bool has_values = field != ColourField::height && field != ColourField::density;
  const std::vector<double> values = has_values ? field_values(patch, field) : std::vector<double>();
  std::vector<Shown> shown;
  shown.reserve(patch.size() + patch.size() / 8);
  for_each_image(patch, [&](std::size_t k, const Vec3& image) {
    const double r = patch.radii[k];
    if (std::fabs(image.x()) < 0.5 * patch.box.size_x + r && std::fabs(image.y()) < 0.5 * patch.box.size_y + r)
      shown.push_back({image, r, patch.ids[k], has_values ? scale.colours.share(values[k]) : 0.0});
  });
  return shown;
}

// Back to front along a direction of view; what is equally far in the order of ids and places.
void sort_along(std::vector<Shown>& shown, const Vec3& direction) {
  for (Shown& s : shown)
    s.toward_viewer = s.position.dot(direction);
  const auto key = [](const Shown& s) { return std::tuple(s.toward_viewer, s.id, s.position.x(), s.position.y()); };
  std::sort(shown.begin(), shown.end(), [&](const Shown& a, const Shown& b) { return key(a) < key(b); });
}

Raster density_view(const Patch& patch, const PictureLayout& layout, const PictureScale& scale) {
  Raster raster(layout.top_view.width, layout.top_view.height, space_colour);
  const DensityMap map(patch);
  for (int j = 0; j < raster.height(); ++j)
    for (int i = 0; i < raster.width(); ++i) {
      const double x = (i + 0.5 - 0.5 * raster.width()) / layout.pixels_per_metre;
      const double y = (0.5 * raster.height() - j - 0.5) / layout.pixels_per_metre;
      raster.pixel(i, j) = field_colour(scale.colours.share(map.at(x, y)));
    }
  return raster;
}

Raster top_view(const PictureLayout& layout, ColourField field, const PictureScale& scale, std::vector<Shown>& shown) {
  Raster raster(layout.top_view.width, layout.top_view.height, space_colour);
  const double pixels = layout.pixels_per_metre;
  sort_along(shown, Vec3::UnitZ());
  for (const Shown& s : shown)
    raster.sphere(0.5 * raster.width() + pixels * s.position.x(), 0.5 * raster.height() - pixels * s.position.y(),
                  pixels * s.radius,
                  field == ColourField::height ? ramp(ring_colours, 0.5 + 0.5 * s.position.z() / scale.depth)
                                               : field_colour(s.share));
  return raster;
}

// Seen from behind, along the orbit: the far end of the box fades.
Raster edge_view(const Patch& patch, const PictureLayout& layout, ColourField field, std::vector<Shown>& shown) {
  Raster raster(layout.edge_view.width, layout.edge_view.height, space_colour);
  const double pixels = layout.pixels_per_metre;
  const bool has_values = field != ColourField::height && field != ColourField::density;
  sort_along(shown, -Vec3::UnitY());
  for (const Shown& s : shown) {
    const double nearness = 0.5 - s.position.y() / patch.box.size_y;
    const Colour colour = has_values ? field_colour(s.share) : ramp(ring_colours, nearness);
    raster.sphere(0.5 * raster.width() + pixels * s.position.x(), 0.5 * raster.height() - pixels * s.position.z(),
                  pixels * s.radius, mix(space_colour, colour, 0.15 + 0.85 * nearness));
  }
  return raster;
}

} // namespace

Colour field_colour(double share) {
  return ramp(field_colours, share);
}

PatchViews patch_views(const Patch& patch, const PictureLayout& layout, ColourField field, const PictureScale& scale) {
  std::vector<Shown> shown = visible(patch, field, scale);
  Raster top =
      field == ColourField::density ? density_view(patch, layout, scale) : top_view(layout, field, scale, shown);
  return {std::move(top), edge_view(patch, layout, field, shown)};
}

} // namespace keeler
