#include "sealed_image.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/hash.hpp>

#include <fmt/format.h>

#include <string>

namespace keeler {
namespace {

constexpr std::string_view mark = "KEELER-SEAL";
constexpr std::size_t seal_size = 64;

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& reason) {
  throw IoError(fmt::format("'{}' is damaged: {}", file.string(), reason));
}

} // namespace

std::string seal_of(std::span<const std::byte> content) {
  Hash hash;
  hash.add_bytes(content);
  return fmt::format("{} {:016x} {}  \n", mark, content.size(), hash.hex()); // 11 + 1 + 16 + 1 + 32 + 3
}

void write_sealed(const std::filesystem::path& file, const hdf5::Handle& image) {
  std::vector<std::byte> bytes = hdf5::image_of(image);
  const std::string seal = seal_of(bytes);
  const std::span<const std::byte> tail = std::as_bytes(std::span(seal));
  bytes.insert(bytes.end(), tail.begin(), tail.end());
  write_file(file, bytes);
}

FileContent load_content(const std::filesystem::path& file) {
  FileContent content{read_file(file), false};
  const std::size_t size = content.bytes.size();
  if (size < seal_size || !as_text(std::span(content.bytes).last(seal_size)).starts_with(mark))
    return content;
  const std::string seal(as_text(std::span(content.bytes).last(seal_size)));
  content.bytes.resize(size - seal_size);
  if (seal != seal_of(content.bytes))
    damaged(file, "its content does not match its checksum");
  content.sealed = true;
  return content;
}

hdf5::Handle open_sealed(const std::filesystem::path& file) {
  const FileContent content = load_content(file);
  if (!content.sealed)
    damaged(file, "its end is missing or it is not a Keeler file");
  return hdf5::open_image(content.bytes);
}

hdf5::Handle open_unsealed(const std::filesystem::path& file, const std::vector<std::byte>& content) {
  try {
    hdf5::Handle image = hdf5::open_image(content);
    // Tools that change a file in place end it where its content ends; anything more is a seal that lost its mark.
    if (hdf5::used_size(image) != content.size())
      damaged(file, "its end is not what was written");
    return image;
  } catch (const IoError& error) {
    if (!as_text(content).starts_with("\x89HDF\r\n\x1a\n"))
      throw IoError(fmt::format("'{}' is no snapshot: it does not begin as HDF5 files do; name a snapshot (.hdf), a "
                                "checkpoint (.h5) or the folder of a run",
                                file.string()));
    throw IoError(fmt::format("cannot read '{}' as HDF5: {}", file.string(), error.what()));
  }
}

} // namespace keeler
