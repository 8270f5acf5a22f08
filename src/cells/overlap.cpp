#include <keeler/cells/overlap.hpp>

#include <keeler/cells/grid.hpp>
#include <keeler/core/threads.hpp>

#include <algorithm>

namespace keeler {
namespace {

// Of equal depths the lowest ids win, so that the answer does not depend on the order of the search.
bool deeper(const Overlap& a, const Overlap& b) {
  if (a.depth != b.depth)
    return a.depth > b.depth;
  return std::pair(a.id_i, a.id_j) < std::pair(b.id_i, b.id_j);
}

} // namespace

Overlap largest_overlap(const Patch& patch) {
  if (patch.size() == 0)
    return {};
  const double r_max = *std::max_element(patch.radii.begin(), patch.radii.end());
  PeriodicGrid grid;
  grid.build(patch.positions, patch.box, patch.offset, 2.0 * r_max);
  std::vector<Overlap> worst(patch.size());
  parallel_for(patch.size(), [&](std::size_t i) {
    const double reach = patch.radii[i] + r_max;
    grid.visit_near(patch.positions[i], reach, reach, [&](std::size_t j, const Image& image) {
      if (patch.ids[j] <= patch.ids[i])
        return;
      const Vec3 d = patch.positions[j] + patch.box.displacement(image, patch.offset) - patch.positions[i];
      const double sum = patch.radii[i] + patch.radii[j];
      const Overlap here{(sum - d.norm()) / sum, patch.ids[i], patch.ids[j]};
      if (here.depth > 0.0 && deeper(here, worst[i]))
        worst[i] = here;
    });
  });
  Overlap result;
  for (const Overlap& candidate : worst)
    if (candidate.depth > 0.0 && deeper(candidate, result))
      result = candidate;
  return result;
}

} // namespace keeler
