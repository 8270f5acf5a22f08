#include <keeler/plot/page.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/html.hpp>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <new>

namespace keeler::plot {
namespace {

void set_colour(cairo_t* cairo, const Colour& colour, double opacity = 1.0) {
  cairo_set_source_rgba(cairo, colour.r, colour.g, colour.b, opacity);
}

std::uint32_t packed(const Colour& colour) {
  const auto byte = [](double value) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
  };
  return 0xff000000u | byte(colour.r) << 16 | byte(colour.g) << 8 | byte(colour.b);
}

void require_drawn(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(ExitCode::run_time, fmt::format("cannot draw the picture: {}", cairo_status_to_string(status)));
}

// Appends to a vector of bytes. An exception must not pass through Cairo.
cairo_status_t take(void* to, const unsigned char* data, unsigned int length) {
  auto& all = *static_cast<std::vector<std::byte>*>(to);
  const auto* begin = reinterpret_cast<const std::byte*>(data);
  try {
    all.insert(all.end(), begin, begin + length);
  } catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

cairo_surface_t* new_surface(PageFormat format, double width, double height, std::vector<std::byte>& bytes) {
  if (format == PageFormat::pdf)
    return cairo_pdf_surface_create_for_stream(take, &bytes, width, height);
  if (format == PageFormat::png)
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width)),
                                      static_cast<int>(std::lround(height)));
  cairo_surface_t* const svg = cairo_svg_surface_create_for_stream(take, &bytes, width, height);
  cairo_svg_surface_set_document_unit(svg, CAIRO_SVG_UNIT_PX);
  return svg;
}

// Returns the SVG without the lines before its root and without its name, which counts surfaces, and with a
// description.
std::vector<std::byte> described(const std::vector<std::byte>& svg, const std::vector<std::string>& texts) {
  std::string all(reinterpret_cast<const char*>(svg.data()), svg.size());
  all.erase(0, all.find("<svg"));
  const std::string name = " id=\"surface";
  if (const std::size_t at = all.find(name); at != std::string::npos)
    all.erase(at, all.find('"', at + name.size()) + 1 - at);
  std::string description = "\n<desc>\n";
  for (const std::string& text : texts)
    description += report::html_text(text) + "\n";
  all.insert(all.find('>') + 1, description + "</desc>");
  const auto* begin = reinterpret_cast<const std::byte*>(all.data());
  return {begin, begin + all.size()};
}

} // namespace

std::optional<PageFormat> page_format(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".png"   ? std::optional(PageFormat::png)
         : ending == ".svg" ? std::optional(PageFormat::svg)
         : ending == ".pdf" ? std::optional(PageFormat::pdf)
                            : std::nullopt;
}

Page::Page(int width, int height, const Colour& background, PageFormat format, double scale)
    : width_(width), height_(height), format_(format),
      surface_(new_surface(format, width * scale, height * scale, written_)), cairo_(cairo_create(surface_)) {
  assert(width > 0 && height > 0 && scale > 0.0);
  if (const cairo_status_t status = cairo_status(cairo_); status != CAIRO_STATUS_SUCCESS) {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
    require_drawn(status);
  }
  cairo_scale(cairo_, scale, scale);
  set_colour(cairo_, background);
  cairo_paint(cairo_);
}

Page::~Page() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void Page::draw_pixels(std::span<const Colour> pixels, int width, int left, int top) {
  const int height = static_cast<int>(pixels.size()) / width;
  assert(format_ == PageFormat::png && left >= 0 && top >= 0 && left + width <= width_ && top + height <= height_);
  cairo_surface_flush(surface_);
  unsigned char* data = cairo_image_surface_get_data(surface_);
  if (data == nullptr)
    return; // drawing failed; pixels() and file_bytes() report it
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface_);
  for (int y = 0; y < height; ++y) {
    auto* pixel_row = reinterpret_cast<std::uint32_t*>(data + (top + y) * stride) + left;
    for (int x = 0; x < width; ++x)
      pixel_row[x] = packed(pixels[static_cast<std::size_t>(y * width + x)]);
  }
  cairo_surface_mark_dirty(surface_);
}

void Page::line(PagePoint from, PagePoint to, const Colour& colour, double width, bool dashed) {
  curve({from, to}, colour, width, dashed);
}

void Page::curve(const std::vector<PagePoint>& points, const Colour& colour, double width, bool dashed) {
  const double dashes[] = {4.0 * width, 3.0 * width};
  cairo_set_dash(cairo_, dashes, dashed ? 2 : 0, 0.0);
  set_colour(cairo_, colour);
  cairo_set_line_width(cairo_, width);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  for (const PagePoint& point : points)
    cairo_line_to(cairo_, point.x, point.y);
  cairo_stroke(cairo_);
  cairo_set_dash(cairo_, nullptr, 0, 0.0);
}

void Page::polygon(const std::vector<PagePoint>& corners, const Colour& colour, double opacity) {
  set_colour(cairo_, colour, opacity);
  for (const PagePoint& corner : corners)
    cairo_line_to(cairo_, corner.x, corner.y);
  cairo_close_path(cairo_);
  cairo_fill(cairo_);
}

void Page::arrow(PagePoint from, PagePoint to, const Colour& colour, double width) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  assert(length > 0.0);
  const double ux = (to.x - from.x) / length, uy = (to.y - from.y) / length, head = 5.0 * width;
  line(from, {to.x - ux * head, to.y - uy * head}, colour, width);
  polygon({to,
           {to.x - head * (1.4 * ux + 0.55 * uy), to.y - head * (1.4 * uy - 0.55 * ux)},
           {to.x - head * (1.4 * ux - 0.55 * uy), to.y - head * (1.4 * uy + 0.55 * ux)}},
          colour);
}

void Page::frame(double left, double top, double width, double height, const Colour& colour) {
  set_colour(cairo_, colour);
  cairo_set_line_width(cairo_, 1.0);
  cairo_rectangle(cairo_, left - 0.5, top - 0.5, width + 1.0, height + 1.0); // on the pixels just outside
  cairo_stroke(cairo_);
}

void Page::shade(double left, double top, double width, double height, const Colour& colour, double opacity) {
  set_colour(cairo_, colour, opacity);
  cairo_rectangle(cairo_, left, top, width, height);
  cairo_fill(cairo_);
}

void Page::begin_clip(double left, double top, double width, double height) {
  cairo_save(cairo_);
  cairo_rectangle(cairo_, left, top, width, height);
  cairo_clip(cairo_);
}

void Page::end_clip() {
  cairo_restore(cairo_);
}

double Page::text(PagePoint base, const std::string& text, const TextStyle& style, bool upward) {
  const double width = text_width(text, style);
  const double back = style.align == Align::left ? 0.0 : style.align == Align::right ? width : 0.5 * width;
  cairo_save(cairo_);
  cairo_translate(cairo_, base.x, base.y);
  if (upward)
    cairo_rotate(cairo_, -0.5 * pi);
  cairo_translate(cairo_, -back, 0.0);
  show(text, style, true);
  cairo_restore(cairo_);
  if (!text.empty())
    texts_.push_back(printable_line(text));
  return width;
}

double Page::text_width(const std::string& text, const TextStyle& style) {
  return show(text, style, false);
}

std::string Page::shortened(const std::string& text, const TextStyle& style, double room) {
  std::string kept = text;
  while (!kept.empty() && text_width(kept == text ? text : kept + "…", style) > room) {
    while ((static_cast<unsigned char>(kept.back()) & 0xc0) == 0x80) // the following bytes of a character in UTF-8
      kept.pop_back();
    kept.pop_back();
  }
  return kept == text ? text : kept + "…";
}

double Page::show(const std::string& words, const TextStyle& style, bool draw) {
  // Cairo's simple text functions; fontconfig substitutes the closest font if this one is not installed.
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  set_colour(cairo_, style.colour);
  const std::string text = printable_line(words);
  double x = 0.0, shift = 0.0; // shift: of the baseline, in sizes
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end =
        std::min(shift != 0.0 ? text.find('}', at) : std::min(text.find("_{", at), text.find("^{", at)), text.size());
    const std::string piece = text.substr(at, end - at);
    cairo_set_font_size(cairo_, shift != 0.0 ? 0.7 * style.size : style.size);
    if (draw) {
      cairo_move_to(cairo_, x, shift * style.size);
      cairo_show_text(cairo_, piece.c_str());
    }
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, piece.c_str(), &extents);
    x += extents.x_advance;
    at = end + (shift != 0.0 ? 1 : 2);
    shift = shift != 0.0 || end >= text.size() ? 0.0 : text[end] == '_' ? 0.2 : -0.4;
  }
  cairo_new_path(cairo_);
  return x;
}

std::span<const std::byte> Page::pixels() {
  assert(format_ == PageFormat::png);
  require_drawn(cairo_status(cairo_));
  cairo_surface_flush(surface_);
  const auto* data = reinterpret_cast<const std::byte*>(cairo_image_surface_get_data(surface_));
  return {data, static_cast<std::size_t>(cairo_image_surface_get_stride(surface_)) *
                    static_cast<std::size_t>(cairo_image_surface_get_height(surface_))};
}

std::vector<std::byte> Page::file_bytes() {
  require_drawn(cairo_status(cairo_));
  if (format_ == PageFormat::png) {
    written_.clear();
    require_drawn(cairo_surface_write_to_png_stream(surface_, take, &written_));
  } else {
    cairo_surface_finish(surface_);
    require_drawn(cairo_surface_status(surface_));
  }
  return format_ == PageFormat::svg ? described(written_, texts_) : written_;
}

void Page::save(const std::string& path) {
  files::write_file(path, file_bytes());
}

} // namespace keeler::plot
