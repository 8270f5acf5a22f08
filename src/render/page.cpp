#include "page.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstdint>
#include <new>

namespace keeler {
namespace {

void set_colour(cairo_t* cairo, const Colour& colour) {
  cairo_set_source_rgb(cairo, colour.r, colour.g, colour.b);
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

} // namespace

Page::Page(int width, int height, const Colour& background)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)), cairo_(cairo_create(surface_)) {
  assert(width > 0 && height > 0);
  if (const cairo_status_t status = cairo_status(cairo_); status != CAIRO_STATUS_SUCCESS) {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
    require_drawn(status);
  }
  set_colour(cairo_, background);
  cairo_paint(cairo_);
}

Page::~Page() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void Page::draw_raster(const Raster& raster, int left, int top) {
  assert(left >= 0 && top >= 0 && left + raster.width() <= width() && top + raster.height() <= height());
  cairo_surface_flush(surface_);
  unsigned char* data = cairo_image_surface_get_data(surface_);
  if (data == nullptr)
    return; // drawing failed; pixels() and png() report it
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface_);
  for (int y = 0; y < raster.height(); ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(data + (top + y) * stride) + left;
    for (int x = 0; x < raster.width(); ++x)
      row[x] = packed(raster.pixel(x, y));
  }
  cairo_surface_mark_dirty(surface_);
}

void Page::line(PagePoint from, PagePoint to, const Colour& colour, double width) {
  set_colour(cairo_, colour);
  cairo_set_line_width(cairo_, width);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  cairo_move_to(cairo_, from.x, from.y);
  cairo_line_to(cairo_, to.x, to.y);
  cairo_stroke(cairo_);
}

void Page::arrow(PagePoint from, PagePoint to, const Colour& colour, double width) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  assert(length > 0.0);
  const double ux = (to.x - from.x) / length, uy = (to.y - from.y) / length, head = 5.0 * width;
  line(from, {to.x - ux * head, to.y - uy * head}, colour, width);
  set_colour(cairo_, colour);
  cairo_move_to(cairo_, to.x, to.y);
  cairo_line_to(cairo_, to.x - head * (1.4 * ux + 0.55 * uy), to.y - head * (1.4 * uy - 0.55 * ux));
  cairo_line_to(cairo_, to.x - head * (1.4 * ux - 0.55 * uy), to.y - head * (1.4 * uy + 0.55 * ux));
  cairo_close_path(cairo_);
  cairo_fill(cairo_);
}

void Page::frame(double left, double top, double width, double height, const Colour& colour) {
  set_colour(cairo_, colour);
  cairo_set_line_width(cairo_, 1.0);
  cairo_rectangle(cairo_, left - 0.5, top - 0.5, width + 1.0, height + 1.0); // on the pixels just outside
  cairo_stroke(cairo_);
}

void Page::dot(PagePoint at, double radius, const Colour& colour) {
  set_colour(cairo_, colour);
  cairo_new_sub_path(cairo_);
  cairo_arc(cairo_, at.x, at.y, radius, 0.0, two_pi);
  cairo_fill(cairo_);
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
  return width;
}

double Page::text_width(const std::string& text, const TextStyle& style) {
  return show(text, style, false);
}

double Page::show(const std::string& text, const TextStyle& style, bool draw) {
  // Cairo's simple text functions; fontconfig substitutes the closest font if this one is not installed.
  cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  set_colour(cairo_, style.colour);
  double x = 0.0;
  std::size_t at = 0;
  bool lowered = false;
  while (at < text.size()) {
    const std::string mark = lowered ? "}" : "_{";
    const std::size_t end = std::min(text.find(mark, at), text.size());
    const std::string piece = text.substr(at, end - at);
    cairo_set_font_size(cairo_, lowered ? 0.7 * style.size : style.size);
    if (draw) {
      cairo_move_to(cairo_, x, lowered ? 0.2 * style.size : 0.0);
      cairo_show_text(cairo_, piece.c_str());
    }
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, piece.c_str(), &extents);
    x += extents.x_advance;
    at = end + mark.size();
    lowered = !lowered;
  }
  cairo_new_path(cairo_);
  return x;
}

std::span<const std::byte> Page::pixels() {
  require_drawn(cairo_status(cairo_));
  cairo_surface_flush(surface_);
  const auto* data = reinterpret_cast<const std::byte*>(cairo_image_surface_get_data(surface_));
  return {data,
          static_cast<std::size_t>(cairo_image_surface_get_stride(surface_)) * static_cast<std::size_t>(height())};
}

std::vector<std::byte> Page::png() {
  std::vector<std::byte> bytes;
  const auto take = [](void* to, const unsigned char* data, unsigned int length) {
    auto& all = *static_cast<std::vector<std::byte>*>(to);
    const auto* begin = reinterpret_cast<const std::byte*>(data);
    try {
      all.insert(all.end(), begin, begin + length);
    } catch (const std::bad_alloc&) { // an exception must not pass through Cairo
      return CAIRO_STATUS_NO_MEMORY;
    }
    return CAIRO_STATUS_SUCCESS;
  };
  require_drawn(cairo_status(cairo_));
  require_drawn(cairo_surface_write_to_png_stream(surface_, take, &bytes));
  return bytes;
}

void Page::save(const std::string& path) {
  write_file(path, png());
}

} // namespace keeler
