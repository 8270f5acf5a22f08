// The order of particles in memory: spatial, so that neighbours share cache lines and pages. No result depends on it.
#pragma once

#include <keeler/cells/folds.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cassert>
#include <cstdint>
#include <vector>

namespace keeler::cells {

/// Returns the indices of the particles in spatial order: by column of small cells, row, and id within a cell. `offset`
/// is the shear offset at the epoch of the elements.
std::vector<std::uint32_t> order_by_position(const Particles& particles, const ShearingBox& box, double offset,
                                             const Folds& folds = {});

/// Permutes values: the new values[k] is the old values[order[k]]. Precondition: both have one length.
template<class T> void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  assert(values.size() == order.size());
  std::vector<T> sorted(values.size());
  parallel_for(values.size(), [&](std::size_t k) { sorted[k] = values[order[k]]; });
  values.swap(sorted);
}

} // namespace keeler::cells
