#include <keeler/render/patch_picture.hpp>

#include "lit_page.hpp"
#include "patch_page.hpp"
#include "patch_views.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/plot/axes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace keeler::render {
namespace {

void draw_header(plot::Page& page, const Patch& patch, const PictureOptions& options, const plot::Theme& theme,
                 double u) {
  page.text({110 * u, 58 * u}, options.title, {32 * u, theme.ink, plot::Align::left, true});
  const std::string facts = fmt::format(
      "t = {:.2f} orbits      N = {}      τ = {:.2f}      Σ = {:.0f} kg/m²      λ_{{cr}} = {:.1f} m      Q = {:.2f}",
      patch.time_orbits, patch.size(), diagnostics::optical_depth(patch), diagnostics::surface_density(patch),
      diagnostics::critical_wavelength(patch), diagnostics::toomre_q(patch));
  page.text({110 * u, 98 * u}, facts, {21 * u, theme.faint_ink});
}

// Returns the first of several names, longest first, that is no wider than `room`; empty if none fits.
std::string fitting(plot::Page& page, std::initializer_list<const char*> names, const plot::TextStyle& style,
                    double room) {
  for (const char* name : names)
    if (page.text_width(name, style) <= room)
      return name;
  return {};
}

// Draws the frame of a view, with metres from its middle. `rise` is pixels per metre of the upward axis.
void draw_axes(plot::Page& page, const PixelFrame& f, double pixels_per_metre, double rise, const plot::Theme& theme,
               double u) {
  const double x = 0.5 * f.width / pixels_per_metre, y = 0.5 * f.height / rise;
  const plot::PageRectangle place{static_cast<double>(f.left), static_cast<double>(f.top), static_cast<double>(f.width),
                                  static_cast<double>(f.height)};
  plot::PlotFrame(place, {.range = {-x, x}}, {.range = {-y, y}}, {theme, 17 * u}).draw_axes(page);
}

// Draws the scale bar and the name of the radial axis, below the top view.
void draw_scale(plot::Page& page, const Patch& patch, const PictureLayout& layout, const plot::Colour& ink, double u) {
  const PixelFrame& f = layout.top_view;
  const double y = f.top + f.height + 62 * u, right = f.left + f.width;
  const double bar = plot::round_below(0.25 * patch.box.size_x), pixels = bar * layout.pixels_per_metre;
  page.line({f.left + 0.5, y - 7 * u}, {f.left + pixels, y - 7 * u}, ink, 3 * u);
  for (const double x : {f.left + 1.5 * u, f.left + pixels - 1.5 * u})
    page.line({x, y - 15 * u}, {x, y + 1 * u}, ink, 3 * u);
  const std::string length =
      fmt::format("{:g} m = {:.2f} λ_{{cr}}", bar, bar / diagnostics::critical_wavelength(patch));
  const double used = pixels + 18 * u + page.text({f.left + pixels + 18 * u, y}, length, {20 * u, ink});
  const plot::TextStyle style{20 * u, ink, plot::Align::right};
  const std::string name =
      fitting(page, {"radial, away from the planet, m", "radial, m", "radial"}, style, f.width - used - 130 * u);
  if (name.empty())
    return;
  page.arrow({right - 90 * u, y - 7 * u}, {right - 1.0, y - 7 * u}, ink, 2 * u);
  page.text({right - 102 * u, y}, name, style);
}

// Draws the name of the upward axis left of a view: the first one that fits.
void draw_upward(plot::Page& page, const PixelFrame& f, std::initializer_list<const char*> names,
                 const plot::Colour& ink, double u) {
  const double x = f.left - 72 * u, arrow = std::min(90 * u, 0.4 * f.height);
  const plot::TextStyle style{20 * u, ink, plot::Align::right};
  page.arrow({x - 7 * u, f.top + arrow}, {x - 7 * u, f.top + 1.0}, ink, 2 * u);
  page.text({x, f.top + arrow + 10 * u}, fitting(page, names, style, f.height - arrow - 10 * u), style, true);
}

// Draws the colour bar below the views.
void draw_colour_bar(plot::Page& page, const PictureLayout& layout, ColourField field, const ColourRange& range,
                     const plot::Theme& theme, double u) {
  const int left = layout.edge_view.left, top = layout.foot + static_cast<int>(72 * u);
  Raster bar(static_cast<int>(420 * u), std::max(2, static_cast<int>(16 * u)), plot::space_colour);
  for (int j = 0; j < bar.height(); ++j)
    for (int i = 0; i < bar.width(); ++i)
      bar.pixel(i, j) = field_colour((i + 0.5) / bar.width());
  page.draw_pixels(bar.pixels(), bar.width(), left, top);
  page.frame(left, top, bar.width(), bar.height(), mix(theme.page, theme.faint_ink, 0.5));
  const double below = top + bar.height() + 22 * u, right = left + bar.width();
  page.text({0.5 * (left + right), below}, format_number(range.middle(), 3),
            {17 * u, theme.faint_ink, plot::Align::centre});
  if (range.high > range.low) {
    page.text({static_cast<double>(left), below}, format_number(range.low, 3), {17 * u, theme.faint_ink});
    page.text({right, below}, format_number(range.high, 3), {17 * u, theme.faint_ink, plot::Align::right});
  }
  page.text({right + 18 * u, top + 0.5 * bar.height() + 7 * u}, label_of(field), {20 * u, theme.ink});
}

} // namespace

void PictureScale::include(const PictureScale& other) {
  half_height = std::max(half_height, other.half_height);
  depth = std::max(depth, other.depth);
  colours.low = std::min(colours.low, other.colours.low);
  colours.high = std::max(colours.high, other.colours.high);
}

PictureScale picture_scale(const Patch& patch, ColourField field) {
  assert(patch.size() > 0);
  std::vector<double> tops;
  for (std::size_t k = 0; k < patch.size(); ++k)
    tops.push_back(std::fabs(patch.positions[k].z()) + patch.radii[k]);
  // The 99.9th percentile, with a margin.
  const auto nearly_all = tops.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(tops.size() - 1));
  std::nth_element(tops.begin(), nearly_all, tops.end());
  return {1.25 * *nearly_all, 2.0 * std::max(diagnostics::scale_height(patch), 1e-3 * diagnostics::mean_radius(patch)),
          field == ColourField::height ? ColourRange() : colour_range(field_values(patch, field), field)};
}

PictureLayout layout_of(const Patch& patch, const PictureOptions& options) {
  assert(options.width > 0);
  const double u = options.width / 1600.0;
  const ShearingBox& box = patch.box;
  PictureLayout layout;
  layout.elevation = (options.oblique ? PictureOptions::oblique_elevation : 90.0) * std::numbers::pi / 180.0;
  const double tall = box.size_y * std::sin(layout.elevation); // height of the upper view, m
  layout.pixels_per_metre = std::min(1430.0 * u / box.size_x, 2200.0 * u / tall);
  const auto pixels = [&](double metres) {
    return std::max(1, static_cast<int>(std::lround(metres * layout.pixels_per_metre)));
  };

  // The edge view is at most as tall as the box is long, and at least as tall as a label.
  const double half_height =
      options.scale ? options.scale->half_height : picture_scale(patch, ColourField::height).half_height;
  layout.half_height =
      std::clamp(half_height, std::min(45.0 * u / layout.pixels_per_metre, 0.5 * box.size_y), 0.5 * box.size_y);

  layout.width = options.width;
  const int left = static_cast<int>(std::lround(110 * u)), margin = static_cast<int>(std::lround(60 * u));
  const int gap = static_cast<int>(std::lround(94 * u));
  layout.top_view = {left, static_cast<int>(std::lround(124 * u)), pixels(box.size_x), pixels(tall)};
  layout.top_view.left += (options.width - left - margin - layout.top_view.width) / 2; // a tall box is centred
  layout.edge_view = {layout.top_view.left, layout.top_view.top + layout.top_view.height + gap, layout.top_view.width,
                      pixels(2.0 * layout.half_height)};
  layout.foot = layout.edge_view.top + layout.edge_view.height;
  layout.height = layout.foot + static_cast<int>(std::lround(80 * u));
  if (options.colour != ColourField::height)
    layout.height += static_cast<int>(std::lround(54 * u)); // the bar
  return layout;
}

std::unique_ptr<plot::Page> patch_page(const Patch& patch, const PictureOptions& asked) {
  if (patch.size() == 0)
    throw UsageError("the patch holds no particles, so there is nothing to draw; choose another snapshot");
  if (asked.width < min_picture_width || asked.width > max_picture_width)
    throw UsageError(fmt::format("a picture cannot be {} pixels wide (possible are {} to {}); choose another width",
                                 asked.width, min_picture_width, max_picture_width));
  if (asked.oblique && asked.colour == ColourField::density)
    throw UsageError("no oblique view of the surface density: it is a map seen from above; choose another field");
  if (asked.lit)
    return lit_page(patch, asked);
  PictureOptions options = asked;
  if (!options.scale)
    options.scale = picture_scale(patch, options.colour);
  const PictureLayout layout = layout_of(patch, options);
  const plot::Theme& theme = options.theme == PictureTheme::light ? plot::light_theme : plot::dark_theme;
  const double u = options.width / 1600.0;
  const PatchViews views = patch_views(patch, layout, options.colour, *options.scale);
  auto page = std::make_unique<plot::Page>(layout.width, layout.height, theme.page);
  page->draw_pixels(views.top.pixels(), views.top.width(), layout.top_view.left, layout.top_view.top);
  page->draw_pixels(views.edge.pixels(), views.edge.width(), layout.edge_view.left, layout.edge_view.top);
  draw_header(*page, patch, options, theme, u);
  draw_scale(*page, patch, layout, theme.ink, u);
  draw_axes(*page, layout.top_view, layout.pixels_per_metre, layout.pixels_per_metre * std::sin(layout.elevation),
            theme, u);
  const std::string oblique =
      fmt::format("along the orbit, m, seen {:g}° above the plane", PictureOptions::oblique_elevation);
  draw_upward(*page, layout.top_view,
              {options.oblique ? oblique.c_str() : "along the orbit, m", "along the orbit", "orbit"}, theme.ink, u);
  draw_axes(*page, layout.edge_view, layout.pixels_per_metre, layout.pixels_per_metre, theme, u);
  draw_upward(*page, layout.edge_view, {"height, m", "height", "z"}, theme.ink, u);
  page->text({static_cast<double>(layout.edge_view.left), layout.foot + 56 * u},
             "edge-on at the same scale, seen along the orbit; the far end of the box fades",
             {18 * u, theme.faint_ink});
  if (options.colour != ColourField::height)
    draw_colour_bar(*page, layout, options.colour, options.scale->colours, theme, u);
  return page;
}

std::vector<std::byte> patch_png(const Patch& patch, const PictureOptions& options) {
  return patch_page(patch, options)->file_bytes();
}

void render_patch(const Patch& patch, const std::string& path, const PictureOptions& options) {
  patch_page(patch, options)->save(path);
}

} // namespace keeler::render
