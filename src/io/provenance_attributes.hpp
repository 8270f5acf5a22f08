// Provenance as text attributes of an HDF5 object.
#pragma once

#include "hdf5.hpp"

#include <keeler/io/provenance.hpp>

namespace keeler::io {

void write_provenance(const hdf5::Handle& object, const Provenance& provenance);

/// Returns all text attributes of the object.
Provenance read_provenance(const hdf5::Handle& object);

} // namespace keeler::io
