// Attributes, and texts in attributes or datasets.
#include "hdf5.hpp"
#include "hdf5_checked.hpp"

#include <keeler/core/error.hpp>

#include <algorithm>

namespace keeler::io::hdf5 {
namespace {

// Returns a type for a text: fixed length, padded with zeros, marked as ASCII when it is, as ParaView's reader needs.
// HDF5 has no text of length 0.
Handle text_type(std::string_view text) {
  const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
  Handle type(checked("make a text", [] { return H5Tcopy(H5T_C_S1); }), H5Tclose);
  checked("make a text", [&] { return H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1)); });
  checked("make a text", [&] { return H5Tset_strpad(type.id(), H5T_STR_NULLPAD); });
  checked("make a text", [&] { return H5Tset_cset(type.id(), ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8); });
  return type;
}

// Returns the bytes to write: an empty text is one zero byte, which readers drop as padding.
std::string padded(std::string_view text) {
  return text.empty() ? std::string(1, '\0') : std::string(text);
}

// Reads one text; `read` calls H5Dread or H5Aread with the memory type and buffer.
template<class Read> std::string read_text(const Handle& type, const Handle& space, const Read& read) {
  const std::string what = "read a text";
  if (layout_of(type, space).type != "text" || layout_of(type, space).count() != 1)
    throw IoError("cannot read a text: it has another type");
  if (checked(what, [&] { return H5Tis_variable_str(type.id()); }) > 0) { // as h5py writes them
    char* variable = nullptr;
    checked(what, [&] { return read(type.id(), &variable); });
    std::string text = variable != nullptr ? variable : "";
    checked(what, [&] { return H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, &variable); });
    return text;
  }
  std::string text(H5Tget_size(type.id()), '\0');
  checked(what, [&] { return read(type.id(), text.data()); });
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

Handle open_attribute(const Handle& object, const std::string& name) {
  return {checked("open attribute '" + name + "'", [&] { return H5Aopen(object.id(), name.c_str(), H5P_DEFAULT); }),
          H5Aclose};
}

Handle type_of(const Handle& attribute) {
  return {checked("read a type", [&] { return H5Aget_type(attribute.id()); }), H5Tclose};
}

Handle space_of(const Handle& attribute) {
  return {checked("read a shape", [&] { return H5Aget_space(attribute.id()); }), H5Sclose};
}

} // namespace

void write_text_dataset(const Handle& parent, const std::string& name, std::string_view text) {
  write_dataset(parent, name, text_type(text).id(), {}, padded(text).data());
}

std::string read_text_dataset(const Handle& parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  const Handle type(checked("read a type", [&] { return H5Dget_type(dataset.id()); }), H5Tclose);
  const Handle space(checked("read a shape", [&] { return H5Dget_space(dataset.id()); }), H5Sclose);
  return read_text(type, space, [&](hid_t memory, void* into) {
    return H5Dread(dataset.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, into);
  });
}

void write_attribute(const Handle& object, const std::string& name, hid_t type, const Shape& shape, const void* data) {
  const std::string what = "write attribute '" + name + "'";
  const Handle space = make_space(shape);
  const auto create = [&] { return H5Acreate2(object.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT); };
  const Handle attribute(checked(what, create), H5Aclose);
  checked(what, [&] { return H5Awrite(attribute.id(), type, data); });
}

void write_attribute(const Handle& object, const std::string& name, std::string_view text) {
  write_attribute(object, name, text_type(text).id(), {}, padded(text).data());
}

bool has_attribute(const Handle& object, const std::string& name) {
  return checked("look for attribute '" + name + "'", [&] { return H5Aexists(object.id(), name.c_str()); }) > 0;
}

std::vector<std::string> attribute_names(const Handle& object) {
  std::vector<std::string> names;
  const auto append = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  checked("list attributes",
          [&] { return H5Aiterate2(object.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append, &names); });
  return names;
}

Layout layout_of_attribute(const Handle& object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  return layout_of(type_of(attribute), space_of(attribute));
}

void read_attribute(const Handle& object, const std::string& name, hid_t type, std::size_t count, void* into) {
  const Handle attribute = open_attribute(object, name);
  if (layout_of(type_of(attribute), space_of(attribute)).count() != count)
    throw IoError("cannot read attribute '" + name + "': it holds another number of values");
  checked("read attribute '" + name + "'", [&] { return H5Aread(attribute.id(), type, into); });
}

std::string read_text_attribute(const Handle& object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  return read_text(type_of(attribute), space_of(attribute),
                   [&](hid_t memory, void* into) { return H5Aread(attribute.id(), memory, into); });
}

} // namespace keeler::io::hdf5
