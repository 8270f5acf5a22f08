#include "sealed_file.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/writers.hpp>
#include <keeler/io/hash.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include <fcntl.h>

namespace keeler::io {
namespace {

constexpr std::string_view mark = "KEELER-SEAL";
constexpr std::size_t seal_size = 64;

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void require_not_written(const std::filesystem::path& file) {
  if (files::is_being_written(file))
    throw IoError(fmt::format("cannot read '{}': {}", file.string(), files::being_written));
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& reason) {
  require_not_written(file);
  throw IoError(fmt::format("'{}' is damaged: {}", file.string(), reason));
}

std::string seal_of(std::uint64_t size, const Hash& hash) {
  return fmt::format("{} {:016x} {}  \n", mark, size, hash.hex()); // 11 + 1 + 16 + 1 + 32 + 3
}

void require_match(const std::filesystem::path& file, const std::string& seal, const std::string& expected) {
  if (seal != expected)
    damaged(file, "its content does not match its checksum");
}

// Returns the last bytes, where a seal would be; zeros for a shorter file.
std::string end_of(const files::Descriptor& descriptor) {
  const std::size_t size = descriptor.size();
  std::string end(seal_size, '\0');
  if (size >= seal_size)
    descriptor.read_at(size - seal_size, std::as_writable_bytes(std::span(end)));
  return end;
}

std::string seal_at_end(const std::filesystem::path& file, const files::Descriptor& descriptor) {
  std::string seal = end_of(descriptor);
  if (!seal.starts_with(mark))
    damaged(file, "its end is missing or it is not a Keeler file");
  return seal;
}

// Hashes the first `size` bytes of a file, piece by piece.
Hash hash_of(const std::filesystem::path& name, const files::Descriptor& file, std::uint64_t size) {
  std::vector<std::byte> piece(std::min<std::uint64_t>(size, std::uint64_t{1} << 20));
  Hash hash;
  for (std::uint64_t offset = 0; offset < size;) {
    const std::span<std::byte> wanted =
        std::span(piece).first(static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), size - offset)));
    const std::size_t have = file.read_at(offset, wanted);
    if (have == 0)
      damaged(name, "it was truncated while it was read");
    hash.add_bytes(wanted.first(have));
    offset += have;
  }
  return hash;
}

// Opens a file for reading at any position, which a pipe or a device does not allow.
std::shared_ptr<files::Descriptor> open_to_read(const std::filesystem::path& file) {
  if (files::reads_once(file))
    throw IoError(fmt::format("cannot read '{}': it is a pipe or a device, and HDF5 needs random access; name a file "
                              "on a disk",
                              file.string()));
  return std::make_shared<files::Descriptor>(file, O_RDONLY);
}

// Refuses a stream before it is opened: a pipe would wait for its reader.
std::filesystem::path file_for_hdf5(const std::filesystem::path& file) {
  files::refuse_stream(file, "HDF5");
  return file;
}

} // namespace

std::string seal_of(std::span<const std::byte> content) {
  Hash hash;
  hash.add_bytes(content);
  return seal_of(content.size(), hash);
}

SealedFile::SealedFile(const std::filesystem::path& file)
    : name_(file), unfinished_(file_for_hdf5(file)), disk_(std::make_shared<hdf5::Disk>(unfinished_.descriptor(), 0)) {
  root_.emplace(hdf5::create_on(disk_));
}

void SealedFile::write(const std::function<void(const hdf5::Handle& root)>& work) {
  assert(root_); // finish() was not called
  try {
    work(*root_);
  } catch (const IoError&) {
    disk_->require_sound(); // has the more precise reason
    throw;
  }
  disk_->require_sound();
}

void SealedFile::finish() {
  write([](const hdf5::Handle& root) { hdf5::flush(root); });
  root_.reset();
  disk_->require_sound();
  if (disk_.use_count() > 1)
    throw IoError(fmt::format("cannot write '{}': HDF5 did not close it", name_.string()));
  const std::string seal = seal_of(disk_->size(), hash_of(name_, disk_->file(), disk_->size()));
  assert(seal.size() == seal_size);
  disk_->file().write_at(disk_->size(), std::as_bytes(std::span(seal)));
  unfinished_.keep();
}

hdf5::Handle open_sealed(const std::filesystem::path& file) {
  const std::shared_ptr<files::Descriptor> opened = open_to_read(file);
  const std::string seal = seal_at_end(file, *opened);
  const std::size_t content = opened->size() - seal_size;
  require_match(file, seal, seal_of(content, hash_of(file, *opened, content)));
  return hdf5::open_on(std::make_shared<hdf5::Disk>(opened, content));
}

bool has_seal(const std::filesystem::path& file) {
  try {
    return end_of(*open_to_read(file)).starts_with(mark);
  } catch (const IoError&) {
    if (files::reads_once(file))
      throw;
    return false; // reading the file will report why
  }
}

std::string seal_in(const std::filesystem::path& file) {
  return seal_at_end(file, *open_to_read(file));
}

hdf5::Handle open_sealed(const std::filesystem::path& file, const std::string& seal) {
  const std::shared_ptr<files::Descriptor> opened = open_to_read(file);
  require_match(file, seal_at_end(file, *opened), seal);
  return hdf5::open_on(std::make_shared<hdf5::Disk>(opened, opened->size() - seal_size));
}

FileContent load_content(const std::filesystem::path& file) {
  FileContent content{files::read_file(file), false};
  const std::size_t size = content.bytes.size();
  if (size < seal_size || !as_text(std::span(content.bytes).last(seal_size)).starts_with(mark)) {
    require_not_written(file); // it may be incomplete
    return content;
  }
  const std::string seal(as_text(std::span(content.bytes).last(seal_size)));
  content.bytes.resize(size - seal_size);
  require_match(file, seal, seal_of(content.bytes));
  content.sealed = true;
  return content;
}

hdf5::Handle open_unsealed(const std::filesystem::path& file, const std::vector<std::byte>& content) {
  try {
    hdf5::Handle image = hdf5::open_image(content);
    // Tools that change a file in place end it at its content; more bytes are a seal whose mark was damaged.
    if (hdf5::used_size(image) != content.size())
      damaged(file, "its end was changed");
    return image;
  } catch (const IoError& error) {
    if (!as_text(content).starts_with("\x89HDF\r\n\x1a\n"))
      throw IoError(fmt::format("'{}' is no snapshot: it does not begin as HDF5 files do; name a snapshot (.hdf), a "
                                "checkpoint (.h5) or the folder of a run",
                                file.string()));
    throw IoError(fmt::format("cannot read '{}' as HDF5: {}", file.string(), error.what()));
  }
}

} // namespace keeler::io
