// The picture of a patch before it becomes a file.
#pragma once

#include "page.hpp"

#include <keeler/render/patch_picture.hpp>

#include <memory>

namespace keeler {

/// Throws as render_patch.
std::unique_ptr<Page> patch_page(const Patch& patch, const PictureOptions& options);

} // namespace keeler
