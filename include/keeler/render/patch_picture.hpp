// A picture of a patch: seen from above, and edge-on along the orbit below it, at the same true scale and aligned in x.
// Particles are lit spheres, the higher (or nearer) in front; images beyond the edges fill the frames.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/render/colour_field.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

enum class PictureTheme { dark, light }; ///< of the page; the views always have a dark sky

/// What pictures must share to be compared: those of a movie have one.
struct PictureScale {
  double half_height = 0.0; ///< nearly all particles stand in |z| up to this, m
  double depth = 0.0;       ///< the height with the brightest shade, m
  ColourRange colours;      ///< of the field; not used for heights

  /// Widens it until it holds the other one too.
  void include(const PictureScale& other);
};

struct PictureOptions {
  std::string title = "Ring patch";
  int width = 1600; ///< of the whole picture, pixels; everything else scales with it
  PictureTheme theme = PictureTheme::dark;
  ColourField colour = ColourField::height;
  bool oblique = false; ///< the upper view is seen from this far above the plane instead of from above
  static constexpr double oblique_elevation = 35.0; // degrees
  std::optional<PictureScale> scale;                ///< none: the patch's own
};

inline constexpr int min_picture_width = 200, max_picture_width = 8000; // pixels

/// A rectangle of whole pixels; y runs down.
struct PixelFrame {
  int left = 0, top = 0, width = 0, height = 0;
};

/// Where things stand in the picture.
struct PictureLayout {
  int width = 0, height = 0; ///< of the whole picture, pixels
  PixelFrame top_view, edge_view;
  int foot = 0; ///< where the lines below the views begin
  double pixels_per_metre = 0.0;
  double half_height = 0.0; ///< the edge view shows |z| up to this, m
  double elevation = 0.0;   ///< of who sees the upper view, above the plane, rad
};

/// Of one patch. Throws UsageError when it does not have the field.
PictureScale picture_scale(const Patch& patch, ColourField field);

PictureLayout layout_of(const Patch& patch, const PictureOptions& options);

/// The picture as the bytes of a PNG file. Throws UsageError when there are no particles or not the field.
std::vector<std::byte> patch_png(const Patch& patch, const PictureOptions& options = {});

/// Writes a PNG. Throws UsageError when there are no particles or not the field, IoError when the file cannot be
/// written.
void render_patch(const Patch& patch, const std::string& path, const PictureOptions& options = {});

} // namespace keeler
