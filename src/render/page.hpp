// A sheet to draw on with Cairo: lines, text with subscripts, pictures, and the PNG at the end.
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

  /// Puts a raster with its upper left corner at a pixel; it must fit.
  void place(const Raster& raster, int left, int top);

  void line(PagePoint from, PagePoint to, const Colour& colour, double width, bool dashed = false);
  void curve(const std::vector<PagePoint>& points, const Colour& colour, double width);
  void arrow(PagePoint from, PagePoint to, const Colour& colour, double width);
  void frame(double left, double top, double width, double height, const Colour& colour);
  void shade(double left, double top, double width, double height, const Colour& colour, double opacity);
  void dot(PagePoint at, double radius, const Colour& colour);

  /// Everything drawn until the end of the clip stays inside the rectangle.
  void begin_clip(double left, double top, double width, double height);
  void end_clip();

  /// Text on a base line, read upward when `upward`; "_{cr}" sets a subscript. Returns its width.
  double text(PagePoint base, const std::string& text, const TextStyle& style, bool upward = false);
  double text_width(const std::string& text, const TextStyle& style);

  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }

  /// Rows of four bytes a pixel: blue, green, red, and one unused. Throws Error when drawing failed.
  std::span<const std::byte> pixels();
  /// The picture as the bytes of a PNG file. Throws Error when drawing failed.
  std::vector<std::byte> png();
  /// Writes it; the name always stands for a complete file. Throws IoError when that fails.
  void save(const std::string& path);

private:
  double show(const std::string& text, const TextStyle& style, bool draw);

  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

} // namespace keeler
