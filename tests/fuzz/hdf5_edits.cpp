#include "hdf5_edits.hpp"

#include "hdf5_checked.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/hash.hpp>

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace keeler::fuzz {
namespace {

constexpr std::size_t seal_size = 64, max_edits = 12;

struct Names {
  std::vector<std::string> objects, attributes; // attributes of any object
};

void add_attributes(hid_t object, Names& names) {
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<Names*>(list)->attributes.emplace_back(name);
    return 0;
  };
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
}

Names all_names(const io::hdf5::Handle& file) {
  Names names;
  const auto add = [](hid_t root, const char* name, const H5O_info_t*, void* list) -> herr_t {
    Names& all = *static_cast<Names*>(list);
    all.objects.emplace_back(name);
    const hid_t object = H5Oopen(root, name, H5P_DEFAULT);
    add_attributes(object, all);
    H5Oclose(object);
    return 0;
  };
  H5Ovisit2(file.id(), H5_INDEX_NAME, H5_ITER_INC, add, &names, H5O_INFO_BASIC);
  return names;
}

std::string pick(Draw& draw, const std::vector<std::string>& names) {
  const std::size_t k = draw.below(names.size() + 1);
  return k < names.size() ? names[k] : std::string(draw.bytes());
}

hid_t text_type(std::size_t size) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, size);
  return type;
}

hid_t compound_type() {
  const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
  H5Tinsert(type, "a", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "b", 8, H5T_NATIVE_INT64);
  return type;
}

hid_t pick_type(Draw& draw) {
  const std::array<hid_t, 10> plain = {H5T_NATIVE_DOUBLE, H5T_NATIVE_FLOAT,  H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                                       H5T_NATIVE_UINT32, H5T_NATIVE_UINT8,  H5T_IEEE_F64BE,   H5T_STD_I16BE,
                                       H5T_STD_REF_OBJ,   H5T_NATIVE_LDOUBLE};
  const std::size_t k = draw.below(plain.size() + 5);
  if (k < plain.size())
    return H5Tcopy(plain[k]);
  switch (k - plain.size()) {
  case 0:
    return text_type(1 + draw.below(64));
  case 1:
    return text_type(H5T_VARIABLE);
  case 2:
    return compound_type();
  case 3:
    return H5Tvlen_create(H5T_NATIVE_DOUBLE);
  default: {
    const hsize_t three = 3;
    return H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &three);
  }
  }
}

// Mostly the eight particles of the file; sometimes none, or more than any file holds.
hid_t pick_space(Draw& draw, hsize_t& count) {
  constexpr std::array<hsize_t, 12> extents = {8, 8, 3, 3, 1, 0, 7, 9, 100, 2, hsize_t{1} << 40, hsize_t{1} << 62};
  const std::size_t rank = draw.below(6);
  count = rank == 4 ? 0 : 1;
  if (rank >= 4)
    return H5Screate(rank == 4 ? H5S_NULL : H5S_SCALAR);
  std::array<hsize_t, 3> shape{};
  for (std::size_t k = 0; k < rank; ++k)
    count *= shape[k] = extents[draw.below(extents.size())];
  return rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(rank), shape.data(), nullptr);
}

double pick_double(Draw& draw) {
  using limits = std::numeric_limits<double>;
  const std::array<double, 16> odd = {0.0,
                                      -0.0,
                                      1.0,
                                      -1.0,
                                      limits::quiet_NaN(),
                                      limits::infinity(),
                                      -limits::infinity(),
                                      1e300,
                                      -1e300,
                                      limits::denorm_min(),
                                      1e9,
                                      1e20,
                                      1e-30,
                                      0.5,
                                      3.0,
                                      1e5};
  const std::size_t k = draw.below(odd.size() + 4);
  if (k < odd.size())
    return odd[k];
  double value = 0.0;
  const std::string_view bytes = draw.bytes();
  std::memcpy(&value, bytes.data(), std::min(bytes.size(), sizeof value));
  return value;
}

// Doubles of the input again and again, as many bytes as one may have to store.
std::vector<double> pick_values(Draw& draw) {
  std::array<double, 4> few{};
  const std::size_t different = 1 + draw.below(few.size());
  for (std::size_t k = 0; k < different; ++k)
    few[k] = pick_double(draw);
  std::vector<double> values(8192);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = few[k % different];
  return values;
}

bool holds_pointers(hid_t type) {
  return H5Tdetect_class(type, H5T_VLEN) > 0 || H5Tis_variable_str(type) > 0;
}

// A new dataset; unwritten where its type holds pointers or it is larger than what there is to write.
void put_dataset(const io::hdf5::Handle& file, const std::string& name, Draw& draw) {
  hsize_t count = 0;
  const io::hdf5::Handle type(pick_type(draw), H5Tclose), space(pick_space(draw, count), H5Sclose);
  const io::hdf5::Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const bool large = count > 4096;
  if (large) {
    const std::array<hsize_t, 3> chunk = {8, 8, 8};
    H5Pset_chunk(list.id(), H5Sget_simple_extent_ndims(space.id()), chunk.data());
  }
  const std::vector<double> values = pick_values(draw);
  H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
  const hid_t made = H5Dcreate2(file.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, list.id(), H5P_DEFAULT);
  if (made < 0)
    return;
  const io::hdf5::Handle dataset(made, H5Dclose);
  if (!large && count * H5Tget_size(type.id()) <= values.size() * sizeof(double) && !holds_pointers(type.id()))
    H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void put_attribute(const io::hdf5::Handle& file, const std::string& object_name, const std::string& name, Draw& draw) {
  const hid_t opened = object_name.empty() ? -1 : H5Oopen(file.id(), object_name.c_str(), H5P_DEFAULT);
  if (opened < 0)
    return;
  const io::hdf5::Handle object(opened, H5Oclose);
  hsize_t count = 0;
  const io::hdf5::Handle type(pick_type(draw), H5Tclose), space(pick_space(draw, count), H5Sclose);
  const std::vector<double> values = pick_values(draw);
  H5Adelete(object.id(), name.c_str());
  if (count > 4096)
    return;
  const hid_t made = H5Acreate2(object.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT);
  if (made < 0)
    return;
  const io::hdf5::Handle attribute(made, H5Aclose);
  if (count * H5Tget_size(type.id()) <= values.size() * sizeof(double) && !holds_pointers(type.id()))
    H5Awrite(attribute.id(), type.id(), values.data());
}

// One number of an array of the file, in place.
void change_value(const io::hdf5::Handle& file, const std::string& name, Draw& draw) {
  const hid_t opened = name.empty() ? -1 : H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT);
  if (opened < 0)
    return;
  const io::hdf5::Handle dataset(opened, H5Dclose);
  const io::hdf5::Layout layout = io::hdf5::layout_of_dataset(dataset);
  if (layout.type == "text" || layout.type == "other" || layout.count() == 0 || layout.count() > 4096)
    return;
  std::vector<double> values(layout.count());
  H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  const std::size_t place = draw.below(values.size());
  values[place] = pick_double(draw);
  H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void put_text(const io::hdf5::Handle& file, const std::string& object_name, const std::string& name, Draw& draw) {
  const hid_t opened = object_name.empty() ? -1 : H5Oopen(file.id(), object_name.c_str(), H5P_DEFAULT);
  if (opened < 0)
    return;
  const io::hdf5::Handle object(opened, H5Oclose);
  H5Adelete(object.id(), name.c_str());
  io::hdf5::write_attribute(object, name, draw.bytes());
}

// A piece of a text dataset.
void change_text(const io::hdf5::Handle& file, const std::string& name, Draw& draw) {
  if (name.empty() || H5Lexists(file.id(), name.c_str(), H5P_DEFAULT) <= 0)
    return;
  std::string text = io::hdf5::read_text_dataset(file, name);
  const std::size_t place = draw.place() % (text.size() + 1), length = draw.byte();
  text.replace(place, length, draw.bytes());
  H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
  io::hdf5::write_text_dataset(file, name, text);
}

void edit_once(const io::hdf5::Handle& file, const Names& names, Draw& draw) {
  const std::size_t kind = draw.below(10);
  const std::string name = pick(draw, names.objects);
  switch (kind) {
  case 0:
    H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
    return;
  case 1:
    return put_dataset(file, name, draw);
  case 2:
    return put_attribute(file, name, pick(draw, names.attributes), draw);
  case 3:
    return put_text(file, name, pick(draw, names.attributes), draw);
  case 4:
    return change_value(file, name, draw);
  case 9:
    return change_text(file, name, draw);
  case 5: {
    const std::string other = pick(draw, names.objects);
    H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
    H5Lcreate_hard(file.id(), other.c_str(), file.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    return;
  }
  case 6: {
    const std::string other = pick(draw, names.objects);
    H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
    H5Lcreate_soft(("/" + other).c_str(), file.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    return;
  }
  case 7: {
    H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
    const hid_t group = H5Gcreate2(file.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (group >= 0)
      H5Gclose(group);
    return;
  }
  default:
    H5Ldelete(file.id(), name.c_str(), H5P_DEFAULT);
    H5Lcreate_external("other.hdf", "/PartType1", file.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
}

} // namespace

std::vector<std::byte> unsealed(const std::filesystem::path& file) {
  std::vector<std::byte> bytes = files::read_file(file);
  bytes.resize(bytes.size() - seal_size);
  return bytes;
}

io::hdf5::Handle open_to_edit(const std::vector<std::byte>& content) {
  static unsigned long count = 0; // HDF5 takes two files of one name for the same
  const io::hdf5::Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), 1 << 16, false);
  H5Pset_file_image(access.id(), const_cast<std::byte*>(content.data()), content.size());
  const std::string name = "edited-" + std::to_string(count++);
  return {io::hdf5::checked("open a file to edit", [&] { return H5Fopen(name.c_str(), H5F_ACC_RDWR, access.id()); }),
          H5Fclose};
}

void edit(const io::hdf5::Handle& file, Draw& draw) {
  const io::hdf5::Quiet quiet;
  const Names names = all_names(file);
  for (std::size_t k = 0; k < max_edits && !draw.empty(); ++k)
    try {
      edit_once(file, names, draw);
    } catch (const IoError&) { // what it was to change is something else by now
    }
}

std::string content_of(const io::hdf5::Handle& file) {
  io::hdf5::checked("complete a file", [&] { return H5Fflush(file.id(), H5F_SCOPE_LOCAL); });
  std::string content(io::hdf5::used_size(file), '\0');
  io::hdf5::checked("copy a file", [&] { return H5Fget_file_image(file.id(), content.data(), content.size()); });
  return content;
}

void renew_checksum(const io::hdf5::Handle& file) {
  if (!io::hdf5::exists(file, "fields"))
    return;
  const io::hdf5::Handle group = io::hdf5::open_group(file, "fields");
  io::Hash hash;
  for (const std::string& name : io::hdf5::names_in(group)) {
    const io::hdf5::Handle dataset = io::hdf5::open_dataset(group, name);
    const io::hdf5::Layout layout = io::hdf5::layout_of_dataset(dataset);
    const io::hdf5::Handle type(H5Dget_type(dataset.id()), H5Tclose);
    std::vector<std::byte> bytes(layout.count() * H5Tget_size(type.id()));
    io::hdf5::read_dataset(dataset, type.id(), bytes.data());
    hash.add_text(name);
    hash.add_text(layout.shape.empty() ? layout.type
                                       : fmt::format("{} [{}]", layout.type, fmt::join(layout.shape, " x ")));
    hash.add_bytes(bytes);
  }
  hash.add_text(io::hdf5::read_text_dataset(file, "scene"));
  const io::hdf5::Quiet quiet;
  H5Adelete(file.id(), "checksum");
  io::hdf5::write_attribute(file, "checksum", hash.hex());
}

} // namespace keeler::fuzz
