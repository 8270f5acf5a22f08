#include "patch_views.hpp"

#include "density_map.hpp"
#include "images.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace keeler::render {
namespace {

// Shades of ring particles: umber far from the viewer, ivory near.
constexpr std::array<plot::Colour, 4> ring_colours = {plot::Colour{0.36, 0.25, 0.18}, plot::Colour{0.70, 0.53, 0.37},
                                                      plot::Colour{0.93, 0.80, 0.62}, plot::Colour{1.0, 0.96, 0.88}};
// Violet through green to yellow: perceptually uniform, also in greyscale and for colour-blind readers.
constexpr std::array<plot::Colour, 5> field_colours = {plot::Colour{0.27, 0.23, 0.52}, plot::Colour{0.16, 0.45, 0.56},
                                                       plot::Colour{0.13, 0.66, 0.52}, plot::Colour{0.48, 0.82, 0.32},
                                                       plot::Colour{0.99, 0.91, 0.14}};

// A particle or periodic image that is visible in the frame.
struct Shown {
  Vec3 position;
  double radius;
  std::uint64_t id;
  double colour_position; // on the colour bar, 0 … 1
  double toward_viewer = 0.0;
};

// The directions of the upper view: upward in the picture, and toward the viewer.
struct ViewAxes {
  explicit ViewAxes(double elevation)
      : up(0.0, std::sin(elevation), std::cos(elevation)), near(0.0, -std::cos(elevation), std::sin(elevation)) {}
  Vec3 up, near;
};

// Returns the particles and images that reach into the frame: as wide as the box, ± half_tall along `up`.
std::vector<Shown> visible(const Patch& patch, ColourField field, const PictureScale& scale, const Vec3& up,
                           double half_tall) {
  const bool has_values = field != ColourField::height && field != ColourField::density;
  const std::vector<double> values = has_values ? field_values(patch, field) : std::vector<double>();
  assert(values.empty() || field == ColourField::density || values.size() == patch.size());
  std::vector<Shown> shown;
  shown.reserve(patch.size() + patch.size() / 8);
  for_each_image(patch, [&](std::size_t k, const Vec3& image) {
    const double r = patch.radii[k];
    if (std::fabs(image.x()) < 0.5 * patch.box.size_x + r && std::fabs(image.dot(up)) < half_tall + r)
      shown.push_back({image, r, patch.ids[k], has_values ? scale.colours.position(values[k]) : 0.0});
  });
  return shown;
}

// Sorts back to front toward the viewer; ties are ordered by id and position.
void sort_along(std::vector<Shown>& shown, const Vec3& direction) {
  for (Shown& s : shown)
    s.toward_viewer = s.position.dot(direction);
  const auto key = [](const Shown& s) { return std::tuple(s.toward_viewer, s.id, s.position.x(), s.position.y()); };
  std::sort(shown.begin(), shown.end(), [&](const Shown& a, const Shown& b) { return key(a) < key(b); });
}

Raster density_view(const Patch& patch, const PictureLayout& layout, const PictureScale& scale) {
  Raster raster(layout.top_view.width, layout.top_view.height, plot::space_colour);
  const DensityMap map(patch);
  for (int j = 0; j < raster.height(); ++j)
    for (int i = 0; i < raster.width(); ++i) {
      const double x = (i + 0.5 - 0.5 * raster.width()) / layout.pixels_per_metre;
      const double y = (0.5 * raster.height() - j - 0.5) / layout.pixels_per_metre;
      raster.pixel(i, j) = field_colour(scale.colours.position(map.at(x, y)));
    }
  return raster;
}

Raster top_view(const PictureLayout& layout, ColourField field, const PictureScale& scale, std::vector<Shown>& shown) {
  Raster raster(layout.top_view.width, layout.top_view.height, plot::space_colour);
  const double pixels = layout.pixels_per_metre;
  const ViewAxes axes(layout.elevation);
  sort_along(shown, axes.near);
  for (const Shown& s : shown)
    raster.sphere(0.5 * raster.width() + pixels * s.position.x(),
                  0.5 * raster.height() - pixels * s.position.dot(axes.up), pixels * s.radius,
                  field == ColourField::height ? ramp(ring_colours, 0.5 + 0.5 * s.position.z() / scale.depth)
                                               : field_colour(s.colour_position));
  return raster;
}

// Draws the view along the orbit, from behind; the far end of the box fades.
Raster edge_view(const Patch& patch, const PictureLayout& layout, ColourField field, std::vector<Shown>& shown) {
  Raster raster(layout.edge_view.width, layout.edge_view.height, plot::space_colour);
  const double pixels = layout.pixels_per_metre;
  const bool has_values = field != ColourField::height && field != ColourField::density;
  sort_along(shown, -Vec3::UnitY());
  for (const Shown& s : shown) {
    const double nearness = 0.5 - s.position.y() / patch.box.size_y;
    const plot::Colour colour = has_values ? field_colour(s.colour_position) : ramp(ring_colours, nearness);
    raster.sphere(0.5 * raster.width() + pixels * s.position.x(), 0.5 * raster.height() - pixels * s.position.z(),
                  pixels * s.radius, mix(plot::space_colour, colour, 0.15 + 0.85 * nearness));
  }
  return raster;
}

} // namespace

plot::Colour field_colour(double position) {
  return ramp(field_colours, position);
}

PatchViews patch_views(const Patch& patch, const PictureLayout& layout, ColourField field, const PictureScale& scale) {
  const double half_y = 0.5 * patch.box.size_y;
  std::vector<Shown> cell = visible(patch, field, scale, Vec3::UnitY(), half_y);
  Raster edge = edge_view(patch, layout, field, cell);
  if (field == ColourField::density)
    return {density_view(patch, layout, scale), std::move(edge)};
  const ViewAxes axes(layout.elevation);
  std::vector<Shown> above = visible(patch, field, scale, axes.up, half_y * std::sin(layout.elevation));
  return {top_view(layout, field, scale, above), std::move(edge)};
}

} // namespace keeler::render
