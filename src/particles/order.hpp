// The order of particles by id, for results that depend on an order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace keeler::particles {

/// Returns the indices of the particles in increasing order of id. Precondition: ids are unique.
std::vector<std::uint32_t> order_by_id(std::span<const std::uint64_t> ids);

} // namespace keeler::particles
