// The order of particles by their ids: for whatever depends on an order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// Which particle has the least id, which the next …
std::vector<std::uint32_t> order_by_id(std::span<const std::uint64_t> ids);

} // namespace keeler
