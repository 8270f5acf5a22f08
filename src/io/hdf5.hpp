// The part of HDF5 that Keeler uses, with every return code checked and no printing by the library.
// Files are made on disk (hdf5_disk.hpp), and read there or from an image in memory. HDF5 as packaged is not
// thread-safe: use this from one thread at a time.
#pragma once

#include <keeler/core/field_table.hpp>

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace keeler::hdf5 {

/// An open HDF5 object; closed when it goes out of scope. Nothing is lost when that close fails: what a file needs is
/// with its disk then, or the failure is known there.
class Handle {
public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle();
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  hid_t id() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// What the functions below throw: IoError "cannot DO WHAT: reason", in our words.

/// Opens, for reading, a file from its bytes, which are copied.
Handle open_image(std::span<const std::byte> image);
/// How many bytes of its image a file uses; bytes beyond that are no part of it.
std::uint64_t used_size(const Handle& file);

Handle create_group(const Handle& parent, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);
bool exists(const Handle& parent, const std::string& name);
bool is_dataset(const Handle& parent, const std::string& name);
/// Names of groups and datasets right below a group, in alphabetical order.
std::vector<std::string> names_in(const Handle& group);
/// Gives an object a second name (a hard link): the same object, not a copy.
void link_again(const Handle& from, const std::string& name, const Handle& to, const std::string& new_name);

/// HDF5's name for the type of a number in memory.
hid_t native_type(FieldType type);
template<class T> hid_t native_type() {
  if constexpr (std::is_same_v<T, std::uint8_t>)
    return H5T_NATIVE_UINT8;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else
    return native_type(field_type<T>());
}

using Shape = std::vector<hsize_t>; ///< empty for a scalar

/// Type and shape of a dataset or attribute; type is "float64", "uint32", ..., "text", or "other".
struct Layout {
  std::string type;
  Shape shape;
  std::size_t count() const;
  bool is_of_numbers() const {
    return type.starts_with("float") || type.starts_with("int") || type.starts_with("uint");
  }
};

enum class Packing {
  plain,     ///< one contiguous block
  compressed ///< chunks with shuffle, gzip and a Fletcher-32 checksum
};

/// A dataset for rows to come.
Handle create_dataset(const Handle& parent, const std::string& name, hid_t type, const Shape& shape,
                      Packing packing = Packing::plain);
/// The one number of a dataset without rows.
void write_scalar(const Handle& dataset, hid_t type, const void* number);
/// `count` rows of a dataset with rows, from the `first` one on. The rows of a compressed one are written by whole
/// multiples of chunk_rows, but for the last ones: else chunks are unpacked and packed again.
inline constexpr std::size_t chunk_rows = std::size_t{1} << 16;
void write_rows(const Handle& dataset, hid_t type, std::size_t first, std::size_t count, const void* data);
void read_rows(const Handle& dataset, hid_t type, std::size_t first, std::size_t count, void* into);

/// Writes a dataset and returns it, for attributes.
Handle write_dataset(const Handle& parent, const std::string& name, hid_t type, const Shape& shape, const void* data,
                     Packing packing = Packing::plain);
template<class T>
Handle write_dataset(const Handle& parent, const std::string& name, const std::vector<T>& data,
                     Packing packing = Packing::plain) {
  return write_dataset(parent, name, native_type<T>(), {data.size()}, data.data(), packing);
}
Handle open_dataset(const Handle& parent, const std::string& name);
Layout layout_of_dataset(const Handle& dataset);
/// Reads a whole dataset as numbers of that type; the caller has made room by its layout.
void read_dataset(const Handle& dataset, hid_t type, void* into);
/// A text of any length.
void write_text_dataset(const Handle& parent, const std::string& name, std::string_view text);
std::string read_text_dataset(const Handle& parent, const std::string& name);

void write_attribute(const Handle& object, const std::string& name, hid_t type, const Shape& shape, const void* data);
void write_attribute(const Handle& object, const std::string& name, std::string_view text);
template<class T>
requires std::is_arithmetic_v<T>
void write_attribute(const Handle& object, const std::string& name, T value) {
  write_attribute(object, name, native_type<T>(), {}, &value);
}
template<class T> void write_attribute(const Handle& object, const std::string& name, const std::vector<T>& values) {
  write_attribute(object, name, native_type<T>(), {values.size()}, values.data());
}

bool has_attribute(const Handle& object, const std::string& name);
std::vector<std::string> attribute_names(const Handle& object);
Layout layout_of_attribute(const Handle& object, const std::string& name);
void read_attribute(const Handle& object, const std::string& name, hid_t type, std::size_t count, void* into);
std::string read_text_attribute(const Handle& object, const std::string& name);
/// All numbers of an attribute.
template<class T> std::vector<T> read_attribute_values(const Handle& object, const std::string& name) {
  std::vector<T> values(layout_of_attribute(object, name).count());
  read_attribute(object, name, native_type<T>(), values.size(), values.data());
  return values;
}
/// The one number of an attribute.
template<class T> T read_attribute(const Handle& object, const std::string& name) {
  T value{};
  read_attribute(object, name, native_type<T>(), 1, &value);
  return value;
}

} // namespace keeler::hdf5
