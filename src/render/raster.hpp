// A plane of pixels on which spheres are painted, back to front. Edges are smoothed by coverage, and each sphere throws
// a soft shadow on what lies behind it, so that crowded places read as depth.
#pragma once

#include "colour.hpp"

#include <vector>

namespace keeler {

class Raster {
public:
  Raster(int width, int height, const Colour& background);

  int width() const { return width_; }
  int height() const { return height_; }
  const Colour& pixel(int x, int y) const { return pixels_[static_cast<std::size_t>(y * width_ + x)]; }
  Colour& pixel(int x, int y) { return pixels_[static_cast<std::size_t>(y * width_ + x)]; }

  /// A lit sphere; centre and radius in pixels, pixel (0, 0) reaching from 0 to 1. Parts outside are cut.
  void sphere(double x, double y, double radius, const Colour& colour);

private:
  int width_, height_;
  std::vector<Colour> pixels_;
};

} // namespace keeler
