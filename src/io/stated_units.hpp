// Units and scales that a file states of its numbers: Keeler takes SI, and refuses what is stated to be something else.
#pragma once

#include "hdf5.hpp"

#include <span>
#include <string>

namespace keeler {

/// Throws IoError where an attribute of a group or dataset, called `name` in messages, states another unit than `unit`
/// (one of m, m/s, kg and rad/s, "1" of what has none, "SI" of all that is below a group), or a scale or an offset.
/// Names of attributes are matched without regard to case, blanks and signs. What states nothing is taken to be SI.
void require_stated_unit(const hdf5::Handle& object, const std::string& name, const std::string& unit);

/// The same of the root, called `root_name`, and of all groups below it that programs write units to.
void require_stated_units_of_groups(const hdf5::Handle& root, const std::string& root_name);

/// Throws IoError when one of a dataset's values is what its attribute _FillValue or missing_value says that missing
/// values have.
void require_none_missing(const hdf5::Handle& dataset, const std::string& name, std::span<const double> values);

/// Throws IoError where a dataset of ids has one that is no whole number from 0 on.
void require_whole_ids(const hdf5::Handle& dataset, const std::string& name);

} // namespace keeler
