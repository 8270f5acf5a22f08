// A pixel raster on which spheres are drawn back to front. Edges are antialiased by coverage, and each sphere casts a
// soft shadow on the spheres behind it, so that crowded regions show depth.
#pragma once

#include <keeler/plot/colour.hpp>

#include <span>
#include <vector>

namespace keeler::render {

class Raster {
public:
  Raster(int width, int height, const plot::Colour& background);

  int width() const { return width_; }
  int height() const { return height_; }
  const plot::Colour& pixel(int x, int y) const { return pixels_[static_cast<std::size_t>(y * width_ + x)]; }
  plot::Colour& pixel(int x, int y) { return pixels_[static_cast<std::size_t>(y * width_ + x)]; }

  std::span<const plot::Colour> pixels() const { return pixels_; }

  /// Draws a lit sphere; centre and radius in pixels, where pixel (0, 0) extends from 0 to 1. Parts outside are
  /// clipped. Precondition: radius > 0.
  void sphere(double x, double y, double radius, const plot::Colour& colour);

private:
  int width_, height_;
  std::vector<plot::Colour> pixels_;
};

} // namespace keeler::render
