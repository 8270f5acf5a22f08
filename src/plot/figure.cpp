#include <keeler/plot/figure.hpp>

#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace keeler::plot {
namespace {

// Colours that stay distinct in the common kinds of colour blindness (M. Okabe and K. Ito, 2008), on white and on
// black.
constexpr Colour rgb(unsigned code) {
  return {(code >> 16) / 255.0, (code >> 8 & 0xff) / 255.0, (code & 0xff) / 255.0};
}
constexpr std::array on_white = {rgb(0x0072b2), rgb(0xd55e00), rgb(0x009e73),
                                 rgb(0xcc79a7), rgb(0x333333), rgb(0xe69f00)};
constexpr std::array on_black = {rgb(0x56b4e9), rgb(0xe69f00), rgb(0x2fc79b),
                                 rgb(0xe396c4), rgb(0xf0e442), rgb(0xd55e00)};

// Lengths in sizes of the text.
constexpr double row = 1.6, gap = 0.8, sample = 2.2;

Colour colour_of(const PlotCurve& curve, const PlotLook& look) {
  const bool light = look.theme.page.r > 0.5;
  return curve.colour ? (light ? on_white : on_black)[*curve.colour % on_white.size()]
                      : mix(look.theme.page, look.theme.faint_ink, 0.55);
}

// Draws the mark of a curve: a disc, square, triangle, diamond or a triangle on its tip.
void draw_mark(Page& page, PagePoint p, const PlotCurve& curve, const PlotLook& look) {
  struct Shape {
    int corners;
    double size, turn; // in radii of the disc; in turns, from the top
  };
  constexpr std::array shapes = {Shape{32, 1.0, 0.0}, Shape{4, 1.4, 0.125}, Shape{3, 1.5, 0.0}, Shape{4, 1.4, 0.0},
                                 Shape{3, 1.5, 0.5}};
  const auto [corners, size, turn] = shapes[curve.colour.value_or(0) % shapes.size()];
  std::vector<PagePoint> polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = two_pi * (turn + static_cast<double>(k) / corners), r = 0.28 * look.text * size;
    polygon.push_back({p.x + r * std::sin(angle), p.y - r * std::cos(angle)});
  }
  page.polygon(polygon, colour_of(curve, look));
}

bool can_be_drawn(const Panel& panel, const PlotPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && (!panel.x.log || point.x > 0.0) &&
         (!panel.y.log || point.y > 0.0);
}

// Returns the panel with all ranges, and without points that cannot be drawn.
Panel with_ranges(Panel panel) {
  AxisRange x, y;
  for (PlotCurve& curve : panel.curves) {
    std::erase_if(curve.points, [&](const PlotPoint& point) { return !can_be_drawn(panel, point); });
    for (PlotPoint& point : curve.points) {
      point.error = std::isfinite(point.error) ? point.error : 0.0;
      x.include(point.x);
      y.include(point.y);
      for (const double end : {point.y - point.error, point.y + point.error})
        if (!curve.band && (!panel.y.log || end > 0.0))
          y.include(end);
    }
  }
  if (panel.x.range.empty())
    panel.x.range = x.empty() ? AxisRange{1.0, 10.0} : x.with_margin(panel.x.log);
  if (panel.y.range.empty())
    panel.y.range = y.empty() ? AxisRange{1.0, 10.0} : y.with_margin(panel.y.log);
  return panel;
}

struct LegendEntry {
  const PlotCurve* curve;
  double x; // units from the left end of the frame
  int row;
};

std::vector<LegendEntry> legend_of(Page& page, const Panel& panel, const PlotLook& look, double width) {
  std::vector<LegendEntry> entries;
  double x = 0.0;
  int rows = 0;
  for (const PlotCurve& curve : panel.curves) {
    if (curve.name.empty())
      continue;
    const double needed = sample * look.text + page.text_width(curve.name, {look.text}) + 1.6 * look.text;
    if (x > 0.0 && x + needed > width + 1.6 * look.text) {
      x = 0.0;
      ++rows;
    }
    entries.push_back({&curve, x, rows});
    x += needed;
  }
  return entries;
}

void draw_legend(Page& page, const std::vector<LegendEntry>& entries, const PlotFrame& frame, const PlotLook& look) {
  for (const LegendEntry& entry : entries) {
    const double left = frame.place().left + entry.x, length = (sample - 0.6) * look.text;
    const double base = frame.place().top - (0.6 + row * (entries.back().row - entry.row)) * look.text;
    const double middle = base - 0.35 * look.text;
    const Colour colour = colour_of(*entry.curve, look);
    if (entry.curve->columns)
      page.shade(left + 0.3 * length, base - 0.75 * look.text, 0.5 * length, 0.75 * look.text, colour, 1.0);
    else if (entry.curve->line)
      page.line({left, middle}, {left + length, middle}, colour, 2.0, entry.curve->dashed);
    if (entry.curve->marks)
      draw_mark(page, {left + 0.5 * length, middle}, *entry.curve, look);
    page.text({left + sample * look.text, base},
              page.shortened(entry.curve->name, {look.text}, frame.place().width - sample * look.text),
              {look.text, look.theme.ink});
  }
}

void draw_columns(Page& page, const PlotCurve& curve, const PlotFrame& frame, const Colour& colour) {
  for (const PlotPoint& point : curve.points) {
    const PagePoint left = frame.at(point.x - 0.45, point.y), right = frame.at(point.x + 0.45, point.y);
    page.shade(left.x, left.y, right.x - left.x, std::max(0.0, frame.place().bottom() - left.y), colour, 1.0);
  }
}

void draw_errors(Page& page, const PlotCurve& curve, const PlotFrame& frame, const PlotLook& look) {
  const Colour colour = colour_of(curve, look);
  std::vector<PagePoint> border;
  for (const PlotPoint& point : curve.points)
    border.push_back(frame.at(point.x, point.y + point.error));
  if (curve.band) {
    for (auto point = curve.points.rbegin(); point != curve.points.rend(); ++point)
      border.push_back(frame.at(point->x, point->y - point->error));
    page.polygon(border, colour, 0.25);
    return;
  }
  const double cap = 0.25 * look.text;
  for (const PlotPoint& point : curve.points)
    if (point.error > 0.0) {
      const PagePoint high = frame.at(point.x, point.y + point.error), low = frame.at(point.x, point.y - point.error);
      page.line(high, low, colour, 1.5);
      for (const PagePoint& end : {high, low})
        page.line({end.x - cap, end.y}, {end.x + cap, end.y}, colour, 1.5);
    }
}

void draw_curve(Page& page, const PlotCurve& curve, const PlotFrame& frame, const PlotLook& look) {
  const Colour colour = colour_of(curve, look);
  if (curve.columns)
    return draw_columns(page, curve, frame, colour);
  draw_errors(page, curve, frame, look);
  std::vector<PagePoint> points;
  for (const PlotPoint& point : curve.points)
    points.push_back(frame.at(point.x, point.y));
  if (curve.line)
    page.curve(points, colour, curve.colour ? 1.8 : 1.2, curve.dashed);
  if (curve.marks)
    for (const PagePoint& point : points)
      draw_mark(page, point, curve, look);
}

bool overlap(const PageRectangle& a, const PageRectangle& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

// Draws the labels of points, each at the first of several places beside its point that is free.
void draw_labels(Page& page, const Panel& panel, const PlotFrame& frame, const PlotLook& look) {
  std::vector<PageRectangle> taken;
  const double r = 0.45 * look.text, height = look.text;
  for (const PlotCurve& curve : panel.curves)
    if (curve.marks)
      for (const PlotPoint& point : curve.points) {
        const PagePoint p = frame.at(point.x, point.y), high = frame.at(point.x, point.y + point.error);
        taken.push_back({p.x - r, p.y - r, 2.0 * r, 2.0 * r});
        taken.push_back({p.x - 2.0, high.y, 4.0, 2.0 * (p.y - high.y)});
      }
  for (const PlotCurve& curve : panel.curves)
    for (const PlotPoint& point : curve.points) {
      if (point.label.empty())
        continue;
      const PagePoint p = frame.at(point.x, point.y);
      const double width = page.text_width(point.label, {0.9 * look.text});
      std::vector<PageRectangle> places;
      for (double step = 1.0; step < 8.0; ++step)
        for (const double side : {-1.0, 1.0}) // above, below
          for (const double left : {p.x + r + 2.0, p.x - r - 2.0 - width})
            places.push_back({left, p.y - 0.5 * height + side * step * 0.75 * height, width, height});
      const auto is_free = [&](const PageRectangle& place) {
        const PageRectangle& all = frame.place();
        return place.left > all.left && place.right() < all.right() && place.top > all.top &&
               place.bottom() < all.bottom() &&
               std::none_of(taken.begin(), taken.end(), [&](const auto& other) { return overlap(place, other); });
      };
      const auto found = std::find_if(places.begin(), places.end(), is_free);
      const PageRectangle& place = found != places.end() ? *found : places.front();
      taken.push_back(place);
      page.text({place.left, place.bottom() - 0.2 * height}, point.label, {0.9 * look.text, look.theme.ink});
    }
}

double space_above(Page& page, const Panel& panel, const PlotLook& look, double width) {
  const std::vector<LegendEntry> legend = legend_of(page, panel, look, width);
  return look.text * (gap + (legend.empty() ? 0.0 : row * (legend.back().row + 1)) + (panel.title.empty() ? 0.0 : row));
}

struct Arrangement {
  std::vector<PageRectangle> frames;
  double height = 0.0; // of the page
};

// Places the panels in rows, with the same space on the left for all.
Arrangement arranged(const Figure& figure, double head) {
  Page ruler(1, 1, figure.look.theme.page);
  const double cell = figure.width / static_cast<double>(figure.columns), text = figure.look.text;
  double left = 0.0;
  for (const Panel& panel : figure.panels)
    left = std::max(left, PlotFrame::space_left(ruler, panel.y, figure.look, figure.panel_height) + gap * text);
  const double width = cell - left - 1.5 * text;
  Arrangement all{{}, head};
  for (std::size_t first = 0; first < figure.panels.size(); first += figure.columns) {
    const std::size_t end = std::min(first + figure.columns, figure.panels.size());
    double above = 0.0, below = 0.0;
    for (std::size_t k = first; k < end; ++k) {
      above = std::max(above, space_above(ruler, figure.panels[k], figure.look, width));
      below = std::max(below, PlotFrame::space_below(ruler, figure.panels[k].x, figure.look, width) + gap * text);
    }
    for (std::size_t k = first; k < end; ++k)
      all.frames.push_back(
          {static_cast<double>(k - first) * cell + left, all.height + above, width, figure.panel_height});
    all.height += above + figure.panel_height + below;
  }
  return all;
}

void draw_panel(Page& page, const Panel& panel, const PageRectangle& place, const PlotLook& look) {
  const PlotFrame frame(place, panel.x, panel.y, look);
  frame.draw_grid(page);
  page.begin_clip(place.left, place.top, place.width, place.height);
  if (panel.shaded) {
    const double from = frame.at(panel.shaded->low, 1.0).x, to = frame.at(panel.shaded->high, 1.0).x;
    page.shade(from, place.top, to - from, place.height, look.theme.faint_ink, 0.13);
  }
  for (const PlotCurve& curve : panel.curves)
    draw_curve(page, curve, frame, look);
  page.end_clip();
  frame.draw_axes(page);
  draw_labels(page, panel, frame, look);
  const std::vector<LegendEntry> legend = legend_of(page, panel, look, place.width);
  draw_legend(page, legend, frame, look);
  const double rows = legend.empty() ? 0.0 : row * (legend.back().row + 1);
  page.text({place.left, place.top - (0.6 + rows) * look.text}, panel.title,
            {1.1 * look.text, look.theme.ink, Align::left, true});
}

} // namespace

std::vector<std::byte> figure_bytes(const Figure& asked, PageFormat format, double scale) {
  assert(!asked.panels.empty() && asked.columns > 0);
  Figure figure = asked;
  std::transform(asked.panels.begin(), asked.panels.end(), figure.panels.begin(), with_ranges);
  const double text = figure.look.text;
  const auto [frames, height] = arranged(figure, figure.title.empty() && figure.note.empty() ? 0.0 : 3.2 * text);
  Page page(figure.width, static_cast<int>(std::ceil(height)), figure.look.theme.page, format, scale);
  const double left = frames.front().left, right = figure.width - 1.5 * text;
  const double used = page.text({left, 2.2 * text}, figure.title, {1.6 * text, figure.look.theme.ink});
  page.text({right, 2.2 * text}, page.shortened(figure.note, {text}, right - left - used - text),
            {text, figure.look.theme.faint_ink, Align::right});
  for (std::size_t k = 0; k < frames.size(); ++k)
    draw_panel(page, figure.panels[k], frames[k], figure.look);
  return page.file_bytes();
}

void save_figures(const Figure& figure, const std::filesystem::path& folder, const std::string& name) {
  files::write_file(folder / (name + ".svg"), figure_bytes(figure, PageFormat::svg));
  files::write_file(folder / (name + ".png"), figure_bytes(figure, PageFormat::png, 2.0));
}

} // namespace keeler::plot
