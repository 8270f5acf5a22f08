#include "hdf5.hpp"

#include "hdf5_checked.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <new>

#include <sys/mman.h>

namespace keeler::io::hdf5 {

std::string fresh_name() {
  static std::atomic<unsigned long> count{0};
  return fmt::format("keeler-{}", count++);
}

void require_memory(std::size_t bytes) {
  constexpr std::size_t for_itself = std::size_t{16} << 20;
  // not by operator new, for which the address sanitizer marks each byte
  void* const pages = mmap(nullptr, for_itself + bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED)
    throw std::bad_alloc();
  munmap(pages, for_itself + bytes);
}

Handle creation_list(hid_t kind) {
  Handle list(checked("prepare an object", [&] { return H5Pcreate(kind); }), H5Pclose);
  checked("prepare an object", [&] { return H5Pset_obj_track_times(list.id(), false); });
  checked("prepare an object",
          [&] { return H5Pset_attr_creation_order(list.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED); });
  return list;
}

namespace {

std::string type_name(hid_t type) {
  switch (checked("read a type", [&] { return H5Tget_class(type); })) {
  case H5T_FLOAT:
    return fmt::format("float{}", 8 * H5Tget_size(type));
  case H5T_INTEGER:
    return fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", 8 * H5Tget_size(type));
  case H5T_STRING:
    return "text";
  default:
    return "other";
  }
}

// Opens an object by call(access property list) but refuses links into other files: an input file must not make the
// program read other files.
template<class Call> hid_t open_inside(hid_t kind, const std::string& what, const Call& call) {
  bool outside = false;
  const auto refuse = [](const char*, const char*, const char*, const char*, unsigned*, hid_t, void* flag) -> herr_t {
    *static_cast<bool*>(flag) = true;
    return -1;
  };
  const Handle list(checked("prepare an access", [&] { return H5Pcreate(kind); }), H5Pclose);
  checked("prepare an access", [&] { return H5Pset_elink_cb(list.id(), refuse, &outside); });
  try {
    return checked(what, [&] { return call(list.id()); });
  } catch (const IoError&) {
    if (outside)
      throw IoError(fmt::format("cannot {}: it is a link into another file, which is not followed", what));
    throw;
  }
}

// Throws IoError when the values of a dataset are stored in another file, or are more than this file can hold: gzip
// compresses at most 1032-fold (zlib technical details), and unwritten values may add a fixed amount.
void require_own_values(const Handle& dataset, const std::string& name) {
  constexpr std::uint64_t max_ratio = 1100, max_unwritten = std::uint64_t{1} << 26; // bytes
  const Handle list(checked("read a layout", [&] { return H5Dget_create_plist(dataset.id()); }), H5Pclose);
  const bool elsewhere = checked("read a layout", [&] { return H5Pget_layout(list.id()); }) == H5D_VIRTUAL ||
                         checked("read a layout", [&] { return H5Pget_external_count(list.id()); }) > 0;
  if (elsewhere)
    throw IoError(fmt::format("cannot open '{}': its values are stored in another file, which is not read", name));
  const Handle type(checked("read a type", [&] { return H5Dget_type(dataset.id()); }), H5Tclose);
  const Layout layout = layout_of_dataset(dataset);
  const Quiet quiet; // the storage size is 0 when it cannot be determined
  const double bytes = static_cast<double>(layout.count()) * static_cast<double>(H5Tget_size(type.id()));
  const double stored = static_cast<double>(H5Dget_storage_size(dataset.id()));
  if (bytes > max_ratio * stored + max_unwritten)
    throw IoError(fmt::format("cannot open '{}': it claims {:.3g} bytes and has {:.3g}", name, bytes, stored));
}

} // namespace

Layout layout_of(const Handle& type, const Handle& space) {
  Layout layout;
  layout.type = type_name(type.id());
  const int rank = checked("read a shape", [&] { return H5Sget_simple_extent_ndims(space.id()); });
  layout.shape.resize(static_cast<std::size_t>(rank));
  checked("read a shape", [&] { return H5Sget_simple_extent_dims(space.id(), layout.shape.data(), nullptr); });
  return layout;
}

Handle make_space(const Shape& shape) {
  const int rank = static_cast<int>(shape.size());
  return {checked("make a shape", [&] { return H5Screate_simple(rank, shape.data(), nullptr); }), H5Sclose};
}

namespace {

// Translates an error for the user; the library's own messages describe its internals.
const char* reason_of(hid_t error) {
  if (error == H5E_NOTFOUND)
    return "it is not there";
  if (error == H5E_NOSPACE || error == H5E_CANTALLOC)
    return "there is not enough memory";
  if (error == H5E_NOFILTER)
    return "it is compressed by an unknown method";
  if (error == H5E_UNSUPPORTED || error == H5E_BADTYPE || error == H5E_CANTCONVERT)
    return "it has a type that does not fit";
  return "its structures are damaged";
}

// Sets compression in chunks of about 1 MB for rows of a few numbers. Precondition: the shape has no zero extent.
void set_compressed(const Handle& list, const Shape& shape) {
  assert(!shape.empty() && shape[0] > 0);
  constexpr unsigned level = 1; // higher levels take several times longer and save a few per cent on such data
  Shape chunk = shape;
  chunk[0] = std::min<hsize_t>(chunk[0], chunk_rows);
  const int rank = static_cast<int>(shape.size());
  checked("set compression", [&] { return H5Pset_chunk(list.id(), rank, chunk.data()); });
  checked("set compression", [&] { return H5Pset_shuffle(list.id()); });
  checked("set compression", [&] { return H5Pset_deflate(list.id(), level); });
  checked("set compression", [&] { return H5Pset_fletcher32(list.id()); });
}

} // namespace

Handle::~Handle() {
  if (id_ >= 0) {
    const Quiet quiet;
    close_(id_);
  }
}

void fail(const std::string& what) {
  hid_t innermost = -1;
  const auto keep_first = [](unsigned depth, const H5E_error2_t* error, void* minor) -> herr_t {
    if (depth == 0)
      *static_cast<hid_t*>(minor) = error->min_num;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &innermost);
  H5Eclear2(H5E_DEFAULT);
  throw IoError(fmt::format("cannot {}: {}", what, reason_of(innermost)));
}

std::size_t Layout::count() const {
  std::size_t product = 1;
  for (const hsize_t extent : shape)
    if (__builtin_mul_overflow(product, extent, &product))
      throw IoError("cannot read a shape: it has more values than can be counted");
  return product;
}

hid_t native_type(FieldType type) {
  switch (type) {
  case FieldType::float64:
    return H5T_NATIVE_DOUBLE;
  case FieldType::float32:
    return H5T_NATIVE_FLOAT;
  case FieldType::int64:
    return H5T_NATIVE_INT64;
  case FieldType::uint64:
    return H5T_NATIVE_UINT64;
  case FieldType::uint32:
    break;
  }
  return H5T_NATIVE_UINT32;
}

Handle open_image(std::span<const std::byte> image) {
  constexpr std::size_t growth = std::size_t{1} << 22;
  require_memory(growth);
  const Handle access(checked("prepare a file in memory", [] { return H5Pcreate(H5P_FILE_ACCESS); }), H5Pclose);
  checked("prepare a file in memory", [&] { return H5Pset_fapl_core(access.id(), growth, false); });
  void* bytes = const_cast<std::byte*>(image.data()); // HDF5 copies it and does not change it
  checked("open a file in memory", [&] { return H5Pset_file_image(access.id(), bytes, image.size()); });
  return {checked("open as HDF5", [&] { return H5Fopen(fresh_name().c_str(), H5F_ACC_RDONLY, access.id()); }),
          H5Fclose};
}

std::uint64_t used_size(const Handle& file) {
  return static_cast<std::uint64_t>(
      checked("read the size of a file", [&] { return H5Fget_file_image(file.id(), nullptr, 0); }));
}

Handle create_group(const Handle& parent, const std::string& name) {
  const Handle list = creation_list(H5P_GROUP_CREATE);
  return {checked("create group '" + name + "'",
                  [&] { return H5Gcreate2(parent.id(), name.c_str(), H5P_DEFAULT, list.id(), H5P_DEFAULT); }),
          H5Gclose};
}

Handle open_group(const Handle& parent, const std::string& name) {
  return {open_inside(H5P_GROUP_ACCESS, "open group '" + name + "'",
                      [&](hid_t list) { return H5Gopen2(parent.id(), name.c_str(), list); }),
          H5Gclose};
}

bool exists(const Handle& parent, const std::string& name) {
  return checked("look for '" + name + "'", [&] { return H5Lexists(parent.id(), name.c_str(), H5P_DEFAULT); }) > 0;
}

bool is_dataset(const Handle& parent, const std::string& name) {
  const Handle object(open_inside(H5P_LINK_ACCESS, "open '" + name + "'",
                                  [&](hid_t list) { return H5Oopen(parent.id(), name.c_str(), list); }),
                      H5Oclose);
  return H5Iget_type(object.id()) == H5I_DATASET;
}

std::vector<std::string> names_in(const Handle& group) {
  std::vector<std::string> names;
  const auto append = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  checked("list a group", [&] { return H5Literate(group.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append, &names); });
  for (const std::string& name : names) // a search of its tree need not find what damage has left in its leaves
    if (name.empty() || !exists(group, name))
      throw IoError("cannot list a group: its structures are damaged");
  return names;
}

void create_hard_link(const Handle& from, const std::string& name, const Handle& to, const std::string& new_name) {
  checked("link '" + new_name + "'",
          [&] { return H5Lcreate_hard(from.id(), name.c_str(), to.id(), new_name.c_str(), H5P_DEFAULT, H5P_DEFAULT); });
}

Handle create_dataset(const Handle& parent, const std::string& name, hid_t type, const Shape& shape, Packing packing) {
  assert(packing == Packing::plain || !shape.empty());
  const Handle space = make_space(shape);
  const Handle list = creation_list(H5P_DATASET_CREATE);
  const bool empty = std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end();
  if (packing == Packing::compressed && !empty)
    set_compressed(list, shape);
  return {checked("write '" + name + "'",
                  [&] {
                    return H5Dcreate2(parent.id(), name.c_str(), type, space.id(), H5P_DEFAULT, list.id(), H5P_DEFAULT);
                  }),
          H5Dclose};
}

Handle write_dataset(const Handle& parent, const std::string& name, hid_t type, const Shape& shape, const void* data,
                     Packing packing) {
  Handle dataset = create_dataset(parent, name, type, shape, packing);
  const std::size_t count = Layout{{}, shape}.count();
  require_memory(count * H5Tget_size(type));
  if (count > 0)
    checked("write '" + name + "'", [&] { return H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data); });
  return dataset;
}

namespace {

// Calls move(memory space, file space) for the rows [first, first + count).
template<class Move>
void move_rows(const std::string& what, const Handle& dataset, std::size_t first, std::size_t count, const Move& move) {
  if (count == 0)
    return;
  const Handle there(checked(what, [&] { return H5Dget_space(dataset.id()); }), H5Sclose);
  Shape shape = layout_of_dataset(dataset).shape, begin(shape.size());
  assert(!shape.empty() && first + count <= shape[0]);
  begin[0] = first;
  shape[0] = count;
  const Handle here = make_space(shape);
  checked(what, [&] {
    return H5Sselect_hyperslab(there.id(), H5S_SELECT_SET, begin.data(), nullptr, shape.data(), nullptr);
  });
  require_memory(Layout{{}, shape}.count() * sizeof(double));
  checked(what, [&] { return move(here.id(), there.id()); });
}

} // namespace

void write_scalar(const Handle& dataset, hid_t type, const void* number) {
  checked("write a dataset", [&] { return H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, number); });
}

void write_rows(const Handle& dataset, hid_t type, std::size_t first, std::size_t count, const void* data) {
  move_rows("write a dataset", dataset, first, count,
            [&](hid_t here, hid_t there) { return H5Dwrite(dataset.id(), type, here, there, H5P_DEFAULT, data); });
}

void read_rows(const Handle& dataset, hid_t type, std::size_t first, std::size_t count, void* into) {
  move_rows("read a dataset", dataset, first, count,
            [&](hid_t here, hid_t there) { return H5Dread(dataset.id(), type, here, there, H5P_DEFAULT, into); });
}

Handle open_dataset(const Handle& parent, const std::string& name) {
  Handle dataset(open_inside(H5P_DATASET_ACCESS, "open '" + name + "'",
                             [&](hid_t list) { return H5Dopen2(parent.id(), name.c_str(), list); }),
                 H5Dclose);
  require_own_values(dataset, name);
  return dataset;
}

Layout layout_of_dataset(const Handle& dataset) {
  const Handle type(checked("read a type", [&] { return H5Dget_type(dataset.id()); }), H5Tclose);
  const Handle space(checked("read a shape", [&] { return H5Dget_space(dataset.id()); }), H5Sclose);
  return layout_of(type, space);
}

void read_dataset(const Handle& dataset, hid_t type, void* into) {
  if (layout_of_dataset(dataset).count() > 0)
    checked("read a dataset", [&] { return H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, into); });
}

} // namespace keeler::io::hdf5
