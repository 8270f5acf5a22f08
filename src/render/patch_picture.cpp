#include <keeler/render/patch_picture.hpp>

#include "page.hpp"

#include <keeler/core/error.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <tuple>

namespace keeler {
namespace {

// Ring particles: umber in the depth, ivory in front.
constexpr std::array<Colour, 4> ring_colours = {Colour{0.36, 0.25, 0.18}, Colour{0.70, 0.53, 0.37},
                                                Colour{0.93, 0.80, 0.62}, Colour{1.0, 0.96, 0.88}};

// A particle, or an image of one, that shows in the frame.
struct Shown {
  Vec3 position;
  double radius;
  std::uint64_t id;
};

// Everything that reaches into the cell, images included.
std::vector<Shown> visible(const Patch& patch) {
  const ShearingBox& box = patch.box;
  std::vector<Shown> shown;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3& p = patch.positions[k];
    const double r = patch.radii[k];
    const Vec3 inside = p + box.displacement(box.image_into_cell(p.x(), p.y(), patch.offset), patch.offset);
    for (int nx = -1; nx <= 1; ++nx)
      for (int ny = -2; ny <= 2; ++ny) {
        const Vec3 image = inside + box.displacement({nx, ny}, patch.offset);
        if (std::fabs(image.x()) < 0.5 * box.size_x + r && std::fabs(image.y()) < 0.5 * box.size_y + r)
          shown.push_back({image, r, patch.ids[k]});
      }
  }
  return shown;
}

// Back to front along a direction of view; what is equally far in the order of ids and places.
void sort_along(std::vector<Shown>& shown, const Vec3& toward_viewer) {
  const auto key = [&](const Shown& s) {
    return std::tuple(s.position.dot(toward_viewer), s.id, s.position.x(), s.position.y());
  };
  std::sort(shown.begin(), shown.end(), [&](const Shown& a, const Shown& b) { return key(a) < key(b); });
}

Raster top_view(const Patch& patch, const PictureLayout& layout, std::vector<Shown>& shown) {
  Raster raster(layout.top_view.width, layout.top_view.height, space_colour);
  const double scale = layout.pixels_per_metre, depth = 2.0 * std::max(scale_height(patch), 1e-3 * mean_radius(patch));
  sort_along(shown, Vec3::UnitZ());
  for (const Shown& s : shown)
    raster.sphere(0.5 * raster.width() + scale * s.position.x(), 0.5 * raster.height() - scale * s.position.y(),
                  scale * s.radius, ramp(ring_colours, 0.5 + 0.5 * s.position.z() / depth));
  return raster;
}

// Seen from behind, along the orbit: the far end of the box fades.
Raster edge_view(const Patch& patch, const PictureLayout& layout, std::vector<Shown>& shown) {
  Raster raster(layout.edge_view.width, layout.edge_view.height, space_colour);
  const double scale = layout.pixels_per_metre;
  sort_along(shown, -Vec3::UnitY());
  for (const Shown& s : shown) {
    const double nearness = 0.5 - s.position.y() / patch.box.size_y;
    raster.sphere(0.5 * raster.width() + scale * s.position.x(), 0.5 * raster.height() - scale * s.position.z(),
                  scale * s.radius, mix(space_colour, ramp(ring_colours, nearness), 0.15 + 0.85 * nearness));
  }
  return raster;
}

// 1, 2 or 5 times a power of ten, at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double step : {5.0, 2.0})
    if (step * power <= length)
      return step * power;
  return power;
}

void draw_header(Page& page, const Patch& patch, const PictureOptions& options, double u) {
  page.text({60 * u, 58 * u}, options.title, {32 * u, ink, Align::left, true});
  const std::string facts = fmt::format(
      "t = {:.2f} orbits      N = {}      τ = {:.2f}      Σ = {:.0f} kg/m²      λ_{{cr}} = {:.1f} m      Q = {:.2f}",
      patch.time_orbits, patch.size(), optical_depth(patch), surface_density(patch), critical_wavelength(patch),
      toomre_q(patch));
  page.text({60 * u, 98 * u}, facts, {21 * u, faint_ink});
}

// The first of several names, longest first, that is no wider than `room`; none when even the last is.
std::string fitting(Page& page, std::initializer_list<const char*> names, const TextStyle& style, double room) {
  for (const char* name : names)
    if (page.text_width(name, style) <= room)
      return name;
  return {};
}

// Below the top view: what is to the right, and how long a metre is.
void draw_scale(Page& page, const Patch& patch, const PictureLayout& layout, double u) {
  const PixelFrame& f = layout.top_view;
  const double y = f.top + f.height + 34 * u, right = f.left + f.width;
  const double bar = round_length(0.25 * patch.box.size_x), pixels = bar * layout.pixels_per_metre;
  page.line({f.left + 0.5, y - 7 * u}, {f.left + pixels, y - 7 * u}, ink, 3 * u);
  for (const double x : {f.left + 1.5 * u, f.left + pixels - 1.5 * u})
    page.line({x, y - 15 * u}, {x, y + 1 * u}, ink, 3 * u);
  const std::string length = fmt::format("{:g} m = {:.2f} λ_{{cr}}", bar, bar / critical_wavelength(patch));
  const double used = pixels + 18 * u + page.text({f.left + pixels + 18 * u, y}, length, {20 * u});
  const TextStyle style{20 * u, ink, Align::right};
  const std::string name = fitting(page, {"radial, away from the planet", "radial"}, style, f.width - used - 130 * u);
  if (name.empty())
    return;
  page.arrow({right - 90 * u, y - 7 * u}, {right - 1.0, y - 7 * u}, ink, 2 * u);
  page.text({right - 102 * u, y}, name, style);
}

// Left of a view: what is up, by the first name that fits.
void draw_upward(Page& page, const PixelFrame& f, std::initializer_list<const char*> names, double u) {
  const double x = f.left - 24 * u, arrow = std::min(90 * u, 0.4 * f.height);
  const TextStyle style{20 * u, ink, Align::right};
  page.arrow({x - 7 * u, f.top + arrow}, {x - 7 * u, f.top + 1.0}, ink, 2 * u);
  page.text({x, f.top + arrow + 10 * u}, fitting(page, names, style, f.height - arrow - 10 * u), style, true);
}

} // namespace

PictureLayout layout_of(const Patch& patch, const PictureOptions& options) {
  const double u = options.width / 1600.0;
  const ShearingBox& box = patch.box;
  PictureLayout layout;
  layout.pixels_per_metre = std::min(1480.0 * u / box.size_x, 2200.0 * u / box.size_y);
  const auto pixels = [&](double metres) {
    return std::max(1, static_cast<int>(std::lround(metres * layout.pixels_per_metre)));
  };

  std::vector<double> tops;
  for (std::size_t k = 0; k < patch.size(); ++k)
    tops.push_back(std::fabs(patch.positions[k].z()) + patch.radii[k]);
  // All but one particle in a thousand, with some air, and never taller than the top view or thinner than a label.
  const auto nearly_all = tops.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(tops.size() - 1));
  std::nth_element(tops.begin(), nearly_all, tops.end());
  layout.half_height =
      std::clamp(1.25 * *nearly_all, std::min(45.0 * u / layout.pixels_per_metre, 0.5 * box.size_y), 0.5 * box.size_y);

  layout.width = options.width;
  const int left = static_cast<int>(std::lround(60 * u)), gap = static_cast<int>(std::lround(64 * u));
  layout.top_view = {left, static_cast<int>(std::lround(124 * u)), pixels(box.size_x), pixels(box.size_y)};
  layout.top_view.left += (options.width - 2 * left - layout.top_view.width) / 2; // a tall box stands in the middle
  layout.edge_view = {layout.top_view.left, layout.top_view.top + layout.top_view.height + gap, layout.top_view.width,
                      pixels(2.0 * layout.half_height)};
  layout.height = layout.edge_view.top + layout.edge_view.height + left;
  return layout;
}

void render_patch(const Patch& patch, const std::string& path, const PictureOptions& options) {
  if (patch.size() == 0)
    throw UsageError("the patch holds no particles, so there is nothing to draw; choose another snapshot");
  const PictureLayout layout = layout_of(patch, options);
  const double u = options.width / 1600.0;
  std::vector<Shown> shown = visible(patch);
  Page page(layout.width, layout.height, page_colour);
  page.place(top_view(patch, layout, shown), layout.top_view.left, layout.top_view.top);
  page.place(edge_view(patch, layout, shown), layout.edge_view.left, layout.edge_view.top);
  for (const PixelFrame& f : {layout.top_view, layout.edge_view})
    page.frame(f.left, f.top, f.width, f.height, mix(page_colour, faint_ink, 0.5));
  draw_header(page, patch, options, u);
  draw_scale(page, patch, layout, u);
  draw_upward(page, layout.top_view, {"along the orbit", "orbit"}, u);
  draw_upward(page, layout.edge_view, {"height", "z"}, u);
  page.text({static_cast<double>(layout.edge_view.left), layout.height - 24 * u},
            "edge-on at the same scale, seen along the orbit; the far end of the box fades", {18 * u, faint_ink});
  page.save(path);
}

} // namespace keeler
