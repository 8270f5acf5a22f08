// The part of HDF5 that Keeler uses, with every return code checked and the library's own error printing off.
// Files are created on disk (hdf5_disk.hpp), and read there or from an image in memory. Packaged HDF5 is not
// thread-safe: call these functions from one thread at a time.
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

namespace keeler::io::hdf5 {

/// Owns an open HDF5 object and closes it. A failure to close is ignored: by then all data has been handed to Disk,
/// which records write failures.
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

// All functions below throw IoError "cannot DO WHAT: reason".

/// Opens a file image for reading. The bytes are copied.
Handle open_image(std::span<const std::byte> image);
/// Returns the number of bytes of its image that a file uses; any bytes after them are ignored.
std::uint64_t used_size(const Handle& file);

Handle create_group(const Handle& parent, const std::string& name);
Handle open_group(const Handle& parent, const std::string& name);
bool exists(const Handle& parent, const std::string& name);
bool is_dataset(const Handle& parent, const std::string& name);
/// Returns the names of the groups and datasets in a group (not below), in alphabetical order.
std::vector<std::string> names_in(const Handle& group);
/// Gives an object a second name (a hard link, no copy).
void create_hard_link(const Handle& from, const std::string& name, const Handle& to, const std::string& new_name);

/// Returns the HDF5 type of a number in memory.
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

/// Type and shape of a dataset or attribute; type is "float64", "uint32", ..., "text" or "other".
struct Layout {
  std::string type;
  Shape shape;
  /// Returns the number of values. Throws IoError when it overflows.
  std::size_t count() const;
  bool is_numeric() const { return type.starts_with("float") || type.starts_with("int") || type.starts_with("uint"); }
};

enum class Packing {
  plain,     ///< one contiguous block
  compressed ///< chunks with shuffle, gzip and a Fletcher-32 checksum
};

/// Creates a dataset; its rows are written later.
Handle create_dataset(const Handle& parent, const std::string& name, hid_t type, const Shape& shape,
                      Packing packing = Packing::plain);
/// Writes a scalar dataset.
void write_scalar(const Handle& dataset, hid_t type, const void* number);
/// Write or read rows [first, first + count) of a dataset. Write compressed datasets in multiples of chunk_rows, except
/// for the last rows: otherwise chunks are decompressed and compressed again. Precondition: the rows exist.
inline constexpr std::size_t chunk_rows = std::size_t{1} << 16;
void write_rows(const Handle& dataset, hid_t type, std::size_t first, std::size_t count, const void* data);
void read_rows(const Handle& dataset, hid_t type, std::size_t first, std::size_t count, void* into);

/// Creates and writes a dataset. Returns it, so that attributes can be added.
Handle write_dataset(const Handle& parent, const std::string& name, hid_t type, const Shape& shape, const void* data,
                     Packing packing = Packing::plain);
template<class T>
Handle write_dataset(const Handle& parent, const std::string& name, const std::vector<T>& data,
                     Packing packing = Packing::plain) {
  return write_dataset(parent, name, native_type<T>(), {data.size()}, data.data(), packing);
}
Handle open_dataset(const Handle& parent, const std::string& name);
Layout layout_of_dataset(const Handle& dataset);
/// Reads a whole dataset, converted to `type`. Precondition: `into` has room for layout_of_dataset().count() values.
void read_dataset(const Handle& dataset, hid_t type, void* into);
/// Write and read one text of any length.
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
/// Returns all numbers of an attribute.
template<class T> std::vector<T> read_attribute_values(const Handle& object, const std::string& name) {
  std::vector<T> values(layout_of_attribute(object, name).count());
  read_attribute(object, name, native_type<T>(), values.size(), values.data());
  return values;
}
/// Returns the number in an attribute. Throws IoError when it holds several.
template<class T> T read_attribute(const Handle& object, const std::string& name) {
  T value{};
  read_attribute(object, name, native_type<T>(), 1, &value);
  return value;
}

} // namespace keeler::io::hdf5
