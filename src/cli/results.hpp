// Output files of commands: their names, and which existing files they may replace.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace keeler::cli {

/// Returns the output file for a name from the command line; "-" is standard output. Throws UsageError for an empty
/// name.
std::filesystem::path output_named(const std::string& name);

/// Returns `name`, the default name of a result of `source`. Throws UsageError if the source is a pipe or a device.
std::filesystem::path output_beside(const std::filesystem::path& source, const std::filesystem::path& name);

/// True if a result goes to standard output; then nothing else may be printed there.
bool is_standard_output(const std::filesystem::path& file);

/// Prints the name of a written file, unless it is standard output.
void print_written(const std::filesystem::path& file);

/// Throws UsageError for an empty name or "-" of a folder for results.
void require_folder_name(const std::filesystem::path& folder);

/// Checks that a new file can be written: throws UsageError for a folder, and for an existing file unless `force`;
/// throws IoError if the file's folder is not writable. Accepts devices and pipes. `what` names the result ("a state").
void require_new_file(const std::filesystem::path& file, bool force, const std::string& what);

/// Throws UsageError if a result would overwrite its source.
void refuse_own_source(const std::filesystem::path& file, const std::filesystem::path& source);

/// Checks that a picture, page or table can be written: it may replace only an earlier one. Throws UsageError for a
/// folder, and for a file without these bytes at this position; throws IoError if the file's folder is not writable.
/// Precondition: `bytes` is not empty.
void require_replaceable(const std::filesystem::path& file, const std::string& what, std::string_view bytes,
                         std::size_t position = 0);

/// Writes a table to a new file, a device or a pipe, or over a table with equal columns. Throws UsageError, IoError.
void write_table(const std::filesystem::path& file, const std::string& table);

} // namespace keeler::cli
