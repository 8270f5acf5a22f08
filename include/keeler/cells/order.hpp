// The order of particles in memory. It follows their places in the box, so that neighbours share cache lines and pages.
// No result depends on it.
#pragma once

#include <keeler/core/threads.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cstdint>
#include <vector>

namespace keeler {

/// Which particle comes first, second …: column by column of small cells, by id within a cell. `offset` is the shear
/// offset at the epoch of the elements.
std::vector<std::uint32_t> order_by_place(const Particles& particles, const ShearingBox& box, double offset);

/// Puts values into that order.
template<class T> void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted(values.size());
  parallel_for(values.size(), [&](std::size_t k) { sorted[k] = values[order[k]]; });
  values.swap(sorted);
}

} // namespace keeler
