// A canvas for Cairo: lines, text with subscripts, pixels, and output as PNG, SVG or PDF.
#pragma once

#include <keeler/plot/colour.hpp>

#include <cairo.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::plot {

enum class PageFormat { png, svg, pdf };

/// Returns the format of a file by its extension; none if it is not one of a page.
std::optional<PageFormat> page_format(const std::filesystem::path& file);

enum class Align { left, centre, right };

struct TextStyle {
  double size = 20.0; ///< units of the page
  Colour colour = ink;
  Align align = Align::left;
  bool bold = false;
};

struct PagePoint {
  double x = 0, y = 0;
};

class Page {
public:
  /// Makes a page of width × height units, each of `scale` pixels (PDF: points).
  Page(int width, int height, const Colour& background, PageFormat format = PageFormat::png, double scale = 1.0);
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  /// Copies rows of pixels, with the upper left corner at a pixel. Preconditions: a PNG of scale 1; they fit into it.
  void draw_pixels(std::span<const Colour> pixels, int width, int left, int top);

  void line(PagePoint from, PagePoint to, const Colour& colour, double width, bool dashed = false);
  void curve(const std::vector<PagePoint>& points, const Colour& colour, double width, bool dashed = false);
  void polygon(const std::vector<PagePoint>& corners, const Colour& colour, double opacity = 1.0);
  void arrow(PagePoint from, PagePoint to, const Colour& colour, double width);
  void frame(double left, double top, double width, double height, const Colour& colour);
  void shade(double left, double top, double width, double height, const Colour& colour, double opacity);

  /// Clips everything drawn until end_clip() to the rectangle.
  void begin_clip(double left, double top, double width, double height);
  void end_clip();

  /// Draws text on a baseline, vertical if `upward`; "_{cr}" sets a subscript, "^{2}" a superscript. Returns its width.
  double text(PagePoint base, const std::string& text, const TextStyle& style, bool upward = false);
  double text_width(const std::string& text, const TextStyle& style);
  /// Returns the text, shortened by "…" if it is wider than `room`.
  std::string shortened(const std::string& text, const TextStyle& style, double room);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Returns rows of four bytes per pixel: blue, green, red, unused. Throws Error when drawing failed. Precondition: a
  /// PNG.
  std::span<const std::byte> pixels();
  /// Returns the bytes of the file; nothing can be drawn afterwards, except on a PNG. The description of an SVG has its
  /// texts, which are drawn as shapes. Throws Error when drawing failed.
  std::vector<std::byte> file_bytes();
  /// Writes the file, atomically: the name always refers to a complete file. Throws IoError when that fails.
  void save(const std::string& path);

private:
  double show(const std::string& text, const TextStyle& style, bool draw);

  int width_, height_;
  PageFormat format_;
  std::vector<std::byte> written_; // by a vector surface, or as PNG
  std::vector<std::string> texts_;
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

} // namespace keeler::plot
