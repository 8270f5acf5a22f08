#include "hdf5_disk.hpp"

#include "hdf5_checked.hpp"

#include <keeler/core/error.hpp>

#include <algorithm>
#include <new>

namespace keeler::io::hdf5 {
namespace {

// The library's handle of an open file.
struct OpenFile : H5FD_t {
  std::shared_ptr<Disk> disk;
  haddr_t allocated = 0;
};

OpenFile& of(H5FD_t* file) {
  return *static_cast<OpenFile*>(file);
}
const OpenFile& of(const H5FD_t* file) {
  return *static_cast<const OpenFile*>(file);
}

H5FD_t* open(const char*, unsigned, hid_t access, haddr_t) {
  const auto* const disk = static_cast<const std::shared_ptr<Disk>* const*>(H5Pget_driver_info(access));
  if (!disk) // a link into another file, which has no such property
    return nullptr;
  auto* const file = new (std::nothrow) OpenFile();
  if (file)
    file->disk = **disk;
  return file;
}

herr_t close(H5FD_t* file) {
  delete &of(file);
  return 0;
}

// Features of HDF5's core driver, so that the file layout equals that of files in memory.
herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t) {
  return of(file).allocated;
}

herr_t allocate(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file).allocated = end;
  return 0;
}

haddr_t end(const H5FD_t* file, H5FD_mem_t) {
  return of(file).disk->size();
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, std::size_t size, void* into) {
  return of(file).disk->read(offset, {static_cast<std::byte*>(into), size}) ? 0 : -1;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, std::size_t size, const void* from) {
  of(file).disk->write(offset, {static_cast<const std::byte*>(from), size});
  return 0;
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  of(file).disk->resize(of(file).allocated);
  return 0;
}

H5FD_class_t driver_class() {
  constexpr H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;
  H5FD_class_t driver = {};
  driver.name = "keeler";
  driver.maxaddr = HADDR_MAX;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(const std::shared_ptr<Disk>*);
  driver.open = open;
  driver.close = close;
  driver.query = query;
  driver.get_eoa = allocated;
  driver.set_eoa = allocate;
  driver.get_eof = end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  std::copy(std::begin(kinds), std::end(kinds), driver.fl_map);
  return driver;
}

hid_t driver() {
  static const H5FD_class_t described = driver_class();
  static const hid_t id = checked("register a driver", [] { return H5FDregister(&described); });
  return id;
}

Handle access_to(const std::shared_ptr<Disk>* disk) {
  require_memory();
  Handle access(checked("prepare a file", [] { return H5Pcreate(H5P_FILE_ACCESS); }), H5Pclose);
  checked("prepare a file", [&] { return H5Pset_driver(access.id(), driver(), &disk); });
  return access;
}

} // namespace

void Disk::require_sound() const {
  if (failure_)
    std::rethrow_exception(failure_);
}

void Disk::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (failure_)
    return;
  try {
    file_->write_at(offset, bytes);
    size_ = std::max(size_, offset + bytes.size());
  } catch (...) {
    failure_ = std::current_exception();
  }
}

bool Disk::read(std::uint64_t offset, std::span<std::byte> into) const {
  const std::size_t available = offset < size_ ? std::min<std::uint64_t>(into.size(), size_ - offset) : 0;
  try {
    const std::size_t have = file_->read_at(offset, into.first(available));
    std::fill(into.begin() + static_cast<std::ptrdiff_t>(have), into.end(), std::byte{0});
    return true;
  } catch (const Error&) {
    return false;
  }
}

void Disk::resize(std::uint64_t size) {
  if (failure_ || size == size_)
    return;
  try {
    file_->truncate(size);
    size_ = size;
  } catch (...) {
    failure_ = std::current_exception();
  }
}

Handle create_on(const std::shared_ptr<Disk>& disk) {
  assert(disk && disk->size() == 0);
  const Handle access = access_to(&disk), creation = creation_list(H5P_FILE_CREATE);
  return {checked("create a file",
                  [&] { return H5Fcreate(fresh_name().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()); }),
          H5Fclose};
}

void flush(const Handle& file) {
  checked("complete a file", [&] { return H5Fflush(file.id(), H5F_SCOPE_LOCAL); });
}

Handle open_on(const std::shared_ptr<Disk>& disk) {
  const Handle access = access_to(&disk);
  return {checked("open as HDF5", [&] { return H5Fopen(fresh_name().c_str(), H5F_ACC_RDONLY, access.id()); }),
          H5Fclose};
}

} // namespace keeler::io::hdf5
