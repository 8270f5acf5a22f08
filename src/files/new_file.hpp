// Atomic output. A file is written under a temporary name in its folder, forced to disk, and then renamed: a full disk,
// a crash or a second writer leaves either the former file or a complete one. Streams (a device, a pipe, a descriptor
// such as /dev/stdout) cannot be replaced: they are written to directly.
#pragma once

#include <keeler/files/descriptor.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace keeler::files {

/// Returns the descriptor of this process that a name refers to, through any links: 1 for /dev/stdout, 3 for /dev/fd/3.
std::optional<int> descriptor_named(const std::filesystem::path& name);

/// True if the name refers to a stream.
bool is_stream(const std::filesystem::path& name);

/// Throws UsageError for a stream; `format` is a format that needs random access.
void refuse_stream(const std::filesystem::path& name, const std::string& format);

/// An output file. Its temporary name is NAME.keeler-XXXXXXXXXXXXXXXX.tmp, with random digits; without keep() it is
/// removed. It gets the permissions of the file that it replaces. It is locked while it is written, so temporary files
/// that killed writers left are unlocked; the constructor removes them. Links are not followed: a link NAME is
/// replaced, unless it leads to a stream.
class NewFile {
public:
  /// Waits for the reader of a named pipe, as write() does. Throws IoError, Interrupted.
  explicit NewFile(std::filesystem::path file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Appends `content`. Throws IoError, Interrupted. Precondition: keep() was not called.
  void write(std::span<const std::byte> content);

  /// Returns the descriptor, for formats that need random access. Precondition: not a stream.
  const std::shared_ptr<Descriptor>& descriptor() const { return out_; }

  /// Forces the file to disk and renames it. Throws IoError. Precondition: called once.
  void keep();

private:
  std::filesystem::path file_, temporary_; // temporary_ is empty for a stream, and after keep()
  std::shared_ptr<Descriptor> out_;
  std::optional<unsigned> replaced_mode_; // permissions of the replaced file
};

/// Returns the final name that belongs to a temporary name; none if it is not a temporary name.
std::optional<std::string_view> unfinished_name(std::string_view name);

/// Removes temporary files of this user that no process is writing any more, if `accept` returns true for their final
/// name. Precondition: accept is not empty.
void remove_left_overs(const std::filesystem::path& folder, const std::function<bool(std::string_view name)>& accept);

} // namespace keeler::files
