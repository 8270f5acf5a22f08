// The picture of a patch as a page in memory.
#pragma once

#include <keeler/plot/page.hpp>

#include <keeler/render/patch_picture.hpp>

#include <memory>

namespace keeler::render {

/// Draws the picture. Throws UsageError as render_patch.
std::unique_ptr<plot::Page> patch_page(const Patch& patch, const PictureOptions& options);

} // namespace keeler::render
