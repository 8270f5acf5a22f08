// The frame of one plot: where values are on the page, ticks with labels, and a grid.
#pragma once

#include <keeler/plot/page.hpp>
#include <keeler/plot/ticks.hpp>

#include <string>
#include <vector>

namespace keeler::plot {

struct PlotAxis {
  std::string label = {};
  bool log = false;
  AxisRange range = {};
  std::vector<std::string> words = {}; ///< labels at 0, 1, 2, … in place of numbers
};

struct PageRectangle {
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;

  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

struct PlotLook {
  Theme theme = light_theme;
  double text = 13.0; ///< size of the labels, units of the page
};

class PlotFrame {
public:
  /// Preconditions: the ranges of the axes are not empty, and positive where they are logarithmic.
  PlotFrame(const PageRectangle& place, const PlotAxis& x, const PlotAxis& y, const PlotLook& look);

  /// Returns the point of two values. On a logarithmic axis, values that are not positive are far below it.
  PagePoint at(double x, double y) const;

  /// Returns the space that the axes need left of a frame of this height, and below one of this width.
  static double space_left(Page& page, const PlotAxis& y, const PlotLook& look, double height);
  static double space_below(Page& page, const PlotAxis& x, const PlotLook& look, double width);

  void draw_grid(Page& page) const;
  /// Draws the frame, the ticks outside of it, and the labels.
  void draw_axes(Page& page) const;

  const PageRectangle& place() const { return place_; }
  /// Returns the colour of frame and ticks.
  Colour line_colour() const { return mix(look_.theme.page, look_.theme.faint_ink, 0.6); }

private:
  void draw_below(Page& page) const;
  void draw_left(Page& page) const;

  PageRectangle place_;
  PlotAxis x_, y_;
  PlotLook look_;
  std::vector<Tick> x_ticks_, y_ticks_;
};

} // namespace keeler::plot
