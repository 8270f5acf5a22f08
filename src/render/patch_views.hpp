// The particles of a patch, painted from above and from the edge.
#pragma once

#include "raster.hpp"

#include <keeler/render/patch_picture.hpp>

namespace keeler {

struct PatchViews {
  Raster top, edge;
};

PatchViews patch_views(const Patch& patch, const PictureLayout& layout, ColourField field, const PictureScale& scale);

/// The colour of a value's share of its range.
Colour field_colour(double share);

} // namespace keeler
