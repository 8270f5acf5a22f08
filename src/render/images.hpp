// The periodic images of particles that may reach into the box.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstddef>

namespace keeler::render {

/// Calls visit(k, position) for every particle k and its images in the box and in the neighbouring ones.
template<class Visit> void for_each_image(const Patch& patch, const Visit& visit) {
  const ShearingBox& box = patch.box;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const Vec3& p = patch.positions[k];
    const Vec3 inside = p + box.displacement(box.image_into_cell(p.x(), p.y(), patch.offset), patch.offset);
    for (int nx = -1; nx <= 1; ++nx)
      for (int ny = -2; ny <= 2; ++ny)
        visit(k, Vec3(inside + box.displacement({nx, ny}, patch.offset)));
  }
}

} // namespace keeler::render
