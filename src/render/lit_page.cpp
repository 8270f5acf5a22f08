// The picture of a patch as an observer sees it in sunlight.
#include "lit_page.hpp"

#include "lit_view.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/plot/axes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::render {
namespace {

constexpr double lowest_frame = 0.3; // height of the view over its width

// Draws the directions of the radius and of the orbital motion, as the observer sees them.
void draw_directions(plot::Page& page, const light::Sight& sight, plot::PagePoint middle, double length,
                     const plot::Colour& ink, double u) {
  const std::pair<Vec3, const char*> axes[] = {{Vec3::UnitX(), "outward"}, {Vec3::UnitY(), "motion"}};
  for (const auto& axis : axes) {
    const auto [right, up] = seen_direction(axis.first, sight);
    const plot::PagePoint end{middle.x + length * right, middle.y - length * up};
    page.arrow(middle, end, ink, 2 * u);
    page.text({end.x + (right < 0.0 ? -8 : 8) * u, end.y + 6 * u}, axis.second,
              {17 * u, ink, right < 0.0 ? plot::Align::right : plot::Align::left});
  }
}

std::string shown(double radians) {
  return format_number(std::round(radians * 180.0 / pi * 100.0) / 100.0, 4) + "°";
}

} // namespace

std::unique_ptr<plot::Page> lit_page(const Patch& patch, const PictureOptions& options) {
  const LitLook& look = *options.lit;
  const plot::Theme& theme = options.theme == PictureTheme::light ? plot::light_theme : plot::dark_theme;
  const double u = options.width / 1600.0;
  const auto pixels = [u](double units) { return static_cast<int>(std::lround(units * u)); };
  const int left = pixels(110), top = pixels(124), width = pixels(1430);
  const double pixels_per_metre = width / patch.box.size_x;
  const double foreshortened = patch.box.size_y * std::fabs(std::sin(look.sight.observer.elevation));
  const int height = std::clamp(static_cast<int>(std::lround(foreshortened * pixels_per_metre)),
                                static_cast<int>(lowest_frame * width), pixels(2200));
  const Raster view = lit_view(patch, look, width, height, pixels_per_metre);
  auto page = std::make_unique<plot::Page>(options.width, top + height + pixels(190), theme.page);
  page->draw_pixels(view.pixels(), width, left, top);
  page->text({110 * u, 58 * u}, options.title, {32 * u, theme.ink, plot::Align::left, true});
  page->text({110 * u, 98 * u},
             fmt::format("t = {:.2f} orbits      N = {}      seen from B = {}, φ = {}      Sun at B' = {}, phase {}",
                         patch.time_orbits, patch.size(), shown(look.sight.observer.elevation),
                         shown(look.sight.observer.azimuth), shown(look.sight.sun.elevation),
                         shown(look.sight.phase())),
             {21 * u, theme.faint_ink});
  const double x = 0.5 * width / pixels_per_metre, y = 0.5 * height / pixels_per_metre;
  plot::PlotFrame(
      {static_cast<double>(left), static_cast<double>(top), static_cast<double>(width), static_cast<double>(height)},
      {.range = {-x, x}}, {.range = {-y, y}}, {theme, 17 * u})
      .draw_axes(*page);
  const double below = top + height;
  page->text({110 * u, below + 66 * u}, "metres across the line of sight, each way", {20 * u, theme.ink});
  page->text({110 * u, below + 104 * u},
             fmt::format("{} face; scattering law {}; I/F from 0, black, to {}, white (gamma 2.2)",
                         look.sight.lit() ? "lit" : "unlit", look.law_text, format_number(white_level(look), 3)),
             {18 * u, theme.faint_ink});
  draw_directions(*page, look.sight, {left + width - 200 * u, below + 110 * u}, 70 * u, theme.ink, u);
  return page;
}

} // namespace keeler::render
