// Checks GADGET's /Header of a snapshot, which repeats what the arrays and /RingBox state, for contradictions.
#pragma once

#include "hdf5.hpp"

#include <keeler/particles/patch.hpp>

#include <cstddef>

namespace keeler::io {

/// Throws IoError naming the attribute when /Header states that the file is one of several, a number of particles other
/// than `count`, a mass per type, or a box or time other than in `patch`. Missing attributes are accepted.
void require_header_fits(const hdf5::Handle& root, const Patch& patch, std::size_t count);

} // namespace keeler::io
