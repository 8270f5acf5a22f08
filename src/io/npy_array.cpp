#include "npy_array.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

namespace keeler::io {

namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they are");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t alignment = 64; // of the values, as numpy writes it

[[noreturn]] void refuse_array(const std::string& where, const std::string& fault) {
  throw UsageError(fmt::format("{} {}", where, fault));
}

// Returns what follows 'KEY': in the header, which is a literal of Python.
std::string_view npy_entry(std::string_view header, const std::string& key, const std::string& where) {
  const std::size_t at = header.find(fmt::format("'{}':", key));
  if (at == std::string_view::npos)
    refuse_array(where, "has a header that is not numpy's; write it by numpy.savez");
  std::string_view rest = header.substr(at + key.size() + 3);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  return rest;
}

std::vector<std::size_t> npy_shape(std::string_view text, const std::string& where) {
  std::vector<std::size_t> shape;
  const std::size_t end = text.find(')');
  if (!text.starts_with('(') || end == std::string_view::npos)
    refuse_array(where, "has no shape; write it by numpy.savez");
  std::size_t number = 0;
  bool in_number = false;
  for (const char c : text.substr(1, end)) { // to the bracket, which ends a number
    if (c >= '0' && c <= '9') {
      number = number * 10 + static_cast<std::size_t>(c - '0');
      in_number = true;
      if (number > std::numeric_limits<std::uint32_t>::max())
        refuse_array(where, "has more than 4 billion rows; split it");
    } else if (in_number) {
      shape.push_back(number);
      number = 0;
      in_number = false;
    }
  }
  return shape;
}

template<class Number> std::vector<double> numbers_in(std::string_view bytes, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    Number number;
    std::memcpy(&number, bytes.data() + k * sizeof(Number), sizeof(Number));
    values[k] = static_cast<double>(number);
  }
  return values;
}

struct NpyType {
  std::string_view name;
  std::size_t size;
  std::vector<double> (*read)(std::string_view bytes, std::size_t count);
};

constexpr NpyType npy_types[] = {
    {"'<f8'", 8, &numbers_in<double>},        {"'<f4'", 4, &numbers_in<float>},
    {"'<i8'", 8, &numbers_in<std::int64_t>},  {"'<i4'", 4, &numbers_in<std::int32_t>},
    {"'<u8'", 8, &numbers_in<std::uint64_t>}, {"'<u4'", 4, &numbers_in<std::uint32_t>},
};

// Reorders the values of a matrix from Fortran's order to C's.
std::vector<double> transposed(const std::vector<double>& values, std::size_t rows, std::size_t columns) {
  std::vector<double> turned(values.size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      turned[row * columns + column] = values[column * rows + row];
  return turned;
}

} // namespace

NpyArray npy_array(std::string_view bytes, const std::string& where) {
  if (!bytes.starts_with(magic) || bytes.size() < 12)
    refuse_array(where, "is no array of numpy; write it by numpy.savez");
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at])); };
  const bool is_short = byte(6) == 1;
  std::size_t start = is_short ? 10 : 12;
  const std::size_t length = byte(8) + (byte(9) << 8U) + (is_short ? 0 : (byte(10) << 16U) + (byte(11) << 24U));
  if (bytes.size() - start < length)
    refuse_array(where, "is cut short; write it again");
  const std::string_view header = bytes.substr(start, length);
  start += length;

  const std::string_view descr = npy_entry(header, "descr", where);
  for (const NpyType& type : npy_types) {
    if (!descr.starts_with(type.name))
      continue;
    NpyArray array{npy_shape(npy_entry(header, "shape", where), where), {}};
    if (array.shape.size() > 2)
      refuse_array(where, "has more than two dimensions; give rows of numbers");
    std::size_t count = 1;
    for (const std::size_t extent : array.shape)
      if (__builtin_mul_overflow(count, extent, &count))
        refuse_array(where, "has more numbers than memory; correct its shape");
    if ((bytes.size() - start) / type.size != count || (bytes.size() - start) % type.size != 0)
      refuse_array(where, "has another length than its shape; write it again");
    array.values = type.read(bytes.substr(start), count);
    if (array.shape.size() == 2 && npy_entry(header, "fortran_order", where).starts_with("True"))
      array.values = transposed(array.values, array.shape[0], array.shape[1]);
    return array;
  }
  refuse_array(where, fmt::format("has the type {}; give numbers, as float64",
                                  descr.substr(0, std::min<std::size_t>(descr.find(','), 20))));
}

std::string npy_header(const std::string& type, const std::vector<std::size_t>& shape) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", type,
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  constexpr std::size_t before = 10; // magic, version, length
  header.append(alignment - 1 - (before + header.size()) % alignment, ' ');
  header += '\n';
  std::string head(magic);
  head += {'\x01', '\x00', static_cast<char>(header.size() & 0xFFU), static_cast<char>(header.size() >> 8U)};
  return head + header;
}

} // namespace keeler::io
