// Units that a file states of its arrays: Keeler takes SI, and refuses what is stated to be something else.
#pragma once

#include "hdf5.hpp"

#include <string>

namespace keeler {

/// Throws IoError where an attribute of the dataset (unit, units, to_cgs, CGSConversionFactor) states another unit than
/// `unit`, one of m, m/s, kg and rad/s. What states nothing is taken to be SI.
void require_stated_unit(const hdf5::Handle& dataset, const std::string& name, const std::string& unit);

} // namespace keeler
