// Checks the units and scales that a file states for its numbers: Keeler requires SI.
#pragma once

#include "hdf5.hpp"

#include <span>
#include <string>

namespace keeler::io {

/// Throws IoError when an attribute of a group or dataset, called `name` in messages, states a unit other than `unit`,
/// or a scale or an offset. Names of attributes are matched by letters and digits, without case. Without such an
/// attribute SI is assumed. Precondition: `unit` is m, m/s, kg, s, rad/s, "1" (dimensionless) or "SI" (for a whole
/// group).
void require_stated_unit(const hdf5::Handle& object, const std::string& name, const std::string& unit);

/// Applies require_stated_unit() to the root, called `root_name` in messages, and to the groups in it that usually have
/// units.
void require_stated_units_of_groups(const hdf5::Handle& root, const std::string& root_name);

/// Throws IoError when one of the dataset's values equals its attribute _FillValue or missing_value.
void require_none_missing(const hdf5::Handle& dataset, const std::string& name, std::span<const double> values);

/// Throws IoError when a dataset of ids has one that is not a whole number >= 0.
void require_whole_ids(const hdf5::Handle& dataset, const std::string& name);

} // namespace keeler::io
