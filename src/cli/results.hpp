// Files that commands write where the user says: what may take the place of what.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace keeler {

/// The file that a user names for a result; "-" is standard output. Throws UsageError where it has no name.
std::filesystem::path output_named(const std::string& name);

/// Where a result goes that a user gives no name: the `name` derived from that of its source. Throws UsageError where
/// the source is a pipe or a device.
std::filesystem::path output_beside(const std::filesystem::path& source, const std::filesystem::path& name);

/// Whether a result goes to standard output: then nothing else may go there.
bool is_standard_output(const std::filesystem::path& file);

/// Prints the name of a file that was written, where it has one.
void print_written(const std::filesystem::path& file);

/// Refuses "-" for results that fill a folder. Throws UsageError.
void require_folder_name(const std::filesystem::path& folder);

/// Refuses to make a file ("a state") where there is a folder, where there is one unless `force`, or where none can be
/// made. A device or a pipe is written to, and replaced by nothing. Throws UsageError, IoError.
void require_new_file(const std::filesystem::path& file, bool force, const std::string& what);

/// Refuses to put a result in the place of the file that it is made from. Throws UsageError.
void refuse_own_source(const std::filesystem::path& file, const std::filesystem::path& source);

/// Pictures, pages and tables are made again as often as one likes, but take the place of nothing else: refuses a
/// folder, and a file that does not have these bytes at this place. Throws UsageError, IoError.
void require_replaceable(const std::filesystem::path& file, const std::string& what, std::string_view bytes,
                         std::size_t place = 0);

/// Writes a table over nothing, over one with the same columns, or to a device or a pipe. Throws UsageError, IoError.
void write_table(const std::filesystem::path& file, const std::string& table);

} // namespace keeler
