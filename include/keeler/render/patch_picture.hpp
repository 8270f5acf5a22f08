// A picture of a patch: seen from above, and edge-on along the orbit below it, at the same true scale and aligned in x.
// Particles are lit spheres, the higher (or nearer) in front; images beyond the edges fill the frames.
#pragma once

#include <keeler/particles/patch.hpp>

#include <string>

namespace keeler {

struct PictureOptions {
  std::string title = "Ring patch";
  int width = 1600; ///< of the whole picture, pixels; everything else scales with it
};

/// A rectangle of whole pixels; y runs down.
struct PixelFrame {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Where things stand in the picture.
struct PictureLayout {
  int width = 0, height = 0; ///< of the whole picture, pixels
  PixelFrame top_view, edge_view;
  double pixels_per_metre = 0.0;
  double half_height = 0.0; ///< the edge view shows |z| up to this, m
};

PictureLayout layout_of(const Patch& patch, const PictureOptions& options);

/// Writes a PNG. Throws UsageError when there are no particles, IoError when the file cannot be written.
void render_patch(const Patch& patch, const std::string& path, const PictureOptions& options = {});

} // namespace keeler
