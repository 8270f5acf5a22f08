#include "results.hpp"

#include "print.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <cassert>
#include <fstream>

#include <unistd.h>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;

void refuse_folder(const fs::path& file, const std::string& what) {
  if (fs::is_directory(file))
    throw UsageError(fmt::format("'{}' is a folder ({} is one file); name a file in it", file.string(), what));
}

// Returns the first bytes of a file; empty if it does not exist or cannot be read.
std::string first_bytes(const fs::path& file, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

} // namespace

fs::path output_named(const std::string& name) {
  if (name.empty())
    throw UsageError("the name of the file to write is empty; name a file, or \"-\" for standard output");
  return name == "-" ? "/dev/stdout" : name;
}

fs::path output_beside(const fs::path& source, const fs::path& name) {
  if (files::reads_once(source) || files::descriptor_named(source))
    throw UsageError(
        fmt::format("'{}' is a pipe or a device, so the result has no default name; name the file to write "
                    "with -o",
                    source.string()));
  return name;
}

bool is_standard_output(const fs::path& file) {
  return files::descriptor_named(file) == STDOUT_FILENO;
}

void print_written(const fs::path& file) {
  if (!is_standard_output(file))
    print("{}\n", file.string());
}

void require_folder_name(const fs::path& folder) {
  if (folder.empty())
    throw UsageError("the name of the folder for the results is empty; name a folder");
  if (folder == "-")
    throw UsageError("'-' is standard output, and the results are many files; name a folder (./- is one)");
}

void require_new_file(const fs::path& file, bool force, const std::string& what) {
  if (files::is_stream(file))
    return;
  refuse_folder(file, what);
  if (fs::exists(file) && !force)
    throw UsageError(
        fmt::format("'{}' exists already ({} is never overwritten without --force); name another file or add "
                    "--force",
                    file.string(), what));
  files::require_writable_folder(files::folder_of(file), file);
}

void refuse_own_source(const fs::path& file, const fs::path& source) {
  std::error_code unknown; // ignored: a file that does not exist
  if (fs::equivalent(file, source, unknown))
    throw UsageError(
        fmt::format("'{}' is the source of the result, and would be lost; name another file", source.string()));
}

void require_replaceable(const fs::path& file, const std::string& what, std::string_view bytes, std::size_t position) {
  assert(!bytes.empty());
  if (files::is_stream(file))
    return;
  refuse_folder(file, what);
  const std::string existing = first_bytes(file, position + bytes.size());
  if (!existing.empty() && (existing.size() < position || existing.substr(position) != bytes))
    throw UsageError(fmt::format("'{}' exists already and is not {}, so it is not replaced; name another file",
                                 file.string(), what));
  files::require_writable_folder(files::folder_of(file), file);
}

void write_table(const fs::path& file, const std::string& table) {
  require_replaceable(file, "a table with these columns", std::string_view(table).substr(0, table.find('\n') + 1));
  files::write_text(file, table);
}

} // namespace keeler::cli
