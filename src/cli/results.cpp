#include "results.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <fstream>

namespace keeler {
namespace {

namespace fs = std::filesystem;

void refuse_folder(const fs::path& file, const std::string& what) {
  if (fs::is_directory(file))
    throw UsageError(fmt::format("'{}' is a folder ({} is one file); name a file in it", file.string(), what));
}

// Of a file that is not there, or cannot be read: nothing.
std::string first_bytes(const fs::path& file, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

} // namespace

void require_new_file(const std::string& path, bool force, const std::string& what) {
  refuse_folder(path, what);
  if (fs::exists(path) && !force)
    throw UsageError("'" + path + "' exists already (" + what +
                     " is never overwritten unasked); name another file or add --force");
  require_writable_folder(fs::absolute(path).parent_path(), path);
}

void require_replaceable(const fs::path& file, const std::string& what, std::string_view bytes, std::size_t place) {
  refuse_folder(file, what);
  const std::string there = first_bytes(file, place + bytes.size());
  if (!there.empty() && (there.size() < place || there.substr(place) != bytes))
    throw UsageError(fmt::format("'{}' exists already, and is not {} that could be made anew; name another file",
                                 file.string(), what));
  require_writable_folder(fs::absolute(file).parent_path(), file);
}

void write_table(const fs::path& file, const std::string& table) {
  refuse_folder(file, "a table");
  require_replaceable(file, "a table with these columns", std::string_view(table).substr(0, table.find('\n') + 1));
  write_text(file, table);
}

} // namespace keeler
