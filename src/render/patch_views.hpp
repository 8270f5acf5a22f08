// The particles of a patch, drawn from above and edge-on.
#pragma once

#include "raster.hpp"

#include <keeler/render/patch_picture.hpp>

namespace keeler::render {

struct PatchViews {
  Raster top, edge;
};

/// Draws both views. Throws UsageError when the patch does not have the field.
PatchViews patch_views(const Patch& patch, const PictureLayout& layout, ColourField field, const PictureScale& scale);

/// Returns the colour at a position on the colour bar, from 0 to 1.
plot::Colour field_colour(double position);

} // namespace keeler::render
