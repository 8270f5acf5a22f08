// What GADGET's /Header of a snapshot says beside the arrays and /RingBox: it must not say something else.
#pragma once

#include "hdf5.hpp"

#include <keeler/particles/patch.hpp>

#include <cstddef>

namespace keeler {

/// Throws IoError that names the attribute where /Header states a part of a snapshot in several files, another number
/// of particles than `count`, masses of its own, or another box or time than `patch`. What is missing states nothing.
void require_header_fits(const hdf5::Handle& root, const Patch& patch, std::size_t count);

} // namespace keeler
