// A picture of a patch: the view from above and, below it, the edge-on view along the orbit, at one true scale and
// aligned in x. Particles are lit spheres, higher (or nearer) ones in front; periodic images fill the frames.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/render/colour_field.hpp>
#include <keeler/render/lit_look.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace keeler::render {

enum class PictureTheme { dark, light }; ///< of the page; the views always have a dark sky

/// The scale that pictures must have in common to be compared, as in a movie.
struct PictureScale {
  double half_height = 0.0; ///< nearly all particles have |z| up to this, m
  double depth = 0.0;       ///< height of the brightest shade, m
  ColourRange colours;      ///< range of the field; unused for heights

  /// Extends the scale to include the other one.
  void include(const PictureScale& other);
};

struct PictureOptions {
  std::string title = "Ring patch";
  int width = 1600; ///< of the picture, pixels; all sizes scale with it
  PictureTheme theme = PictureTheme::dark;
  ColourField colour = ColourField::height;
  bool oblique = false;                             ///< the upper view is from oblique_elevation instead of from above
  static constexpr double oblique_elevation = 35.0; ///< degrees above the plane
  std::optional<PictureScale> scale;                ///< none: picture_scale() of the patch
  std::optional<LitLook> lit; ///< instead of both views: the patch as an observer sees it in sunlight
};

inline constexpr int min_picture_width = 200, max_picture_width = 8000; // pixels

/// A rectangle of whole pixels; y points down.
struct PixelFrame {
  int left = 0, top = 0, width = 0, height = 0;
};

/// The positions of the parts of a picture.
struct PictureLayout {
  int width = 0, height = 0; ///< of the whole picture, pixels
  PixelFrame top_view, edge_view;
  int foot = 0; ///< top of the lines below the views
  double pixels_per_metre = 0.0;
  double half_height = 0.0; ///< the edge view shows |z| up to this, m
  double elevation = 0.0;   ///< of the viewer of the upper view above the plane, rad
};

/// Returns the scale of one patch. Precondition: it holds a particle. Throws UsageError when it does not have the
/// field.
PictureScale picture_scale(const Patch& patch, ColourField field);

/// Returns the layout. Precondition: the patch holds a particle, or `options.scale` is set.
PictureLayout layout_of(const Patch& patch, const PictureOptions& options);

/// Returns the bytes of a PNG file. Throws UsageError when the patch has no particles or not the field.
std::vector<std::byte> patch_png(const Patch& patch, const PictureOptions& options = {});

/// Writes a PNG file. Throws as patch_png(), and IoError when the file cannot be written.
void render_patch(const Patch& patch, const std::string& path, const PictureOptions& options = {});

} // namespace keeler::render
