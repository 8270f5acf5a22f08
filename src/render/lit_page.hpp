// The page of a picture in sunlight.
#pragma once

#include <keeler/plot/page.hpp>

#include <keeler/render/patch_picture.hpp>

#include <memory>

namespace keeler::render {

/// Draws the patch as `options.lit` says. Preconditions: it is set; the patch has particles. Throws Error without
/// Embree.
std::unique_ptr<plot::Page> lit_page(const Patch& patch, const PictureOptions& options);

} // namespace keeler::render
