// Arrays in the format of numpy's npy files, versions 1 to 3, little-endian.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace keeler::io {

struct NpyArray {
  std::vector<std::size_t> shape; ///< empty: one number
  std::vector<double> values;     ///< in C's order: the last index runs fastest
};

/// Reads an array of floating-point or whole numbers. Throws UsageError "WHERE: what is wrong; what to do".
NpyArray npy_array(std::string_view bytes, const std::string& where);

/// Returns the head of an array in C's order, before its values. `type` is numpy's: "<f8".
std::string npy_header(const std::string& type, const std::vector<std::size_t>& shape);

} // namespace keeler::io
