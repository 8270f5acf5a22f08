// A canvas for Cairo: lines, text with subscripts, rasters, and output as PNG.
#pragma once

#include "colour.hpp"
#include "raster.hpp"

#include <cairo.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace keeler {

enum class Align { left, centre, right };

struct TextStyle {
  double size = 20.0; ///< pixels
  Colour colour = ink;
  Align align = Align::left;
  bool bold = false;
};

struct PagePoint {
  double x = 0, y = 0;
};

class Page {
public:
  Page(int width, int height, const Colour& background);
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  /// Copies a raster, with its upper left corner at a pixel. Precondition: it fits into the page.
  void draw_raster(const Raster& raster, int left, int top);

  void line(PagePoint from, PagePoint to, const Colour& colour, double width);
  void arrow(PagePoint from, PagePoint to, const Colour& colour, double width);
  void frame(double left, double top, double width, double height, const Colour& colour);
  void dot(PagePoint at, double radius, const Colour& colour);

  /// Draws text on a baseline, vertical if `upward`; "_{cr}" sets a subscript. Returns its width.
  double text(PagePoint base, const std::string& text, const TextStyle& style, bool upward = false);
  double text_width(const std::string& text, const TextStyle& style);

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }

  /// Returns rows of four bytes per pixel: blue, green, red, unused. Throws Error when drawing failed.
  std::span<const std::byte> pixels();
  /// Returns the bytes of a PNG file. Throws Error when drawing failed.
  std::vector<std::byte> png();
  /// Writes a PNG file, atomically: the name always refers to a complete file. Throws IoError when that fails.
  void save(const std::string& path);

private:
  double show(const std::string& text, const TextStyle& style, bool draw);

  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

} // namespace keeler
