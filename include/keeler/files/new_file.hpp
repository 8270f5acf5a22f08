// Output in the making. A file is written under a name of its own beside the one that it is to get, forced to disk, and
// only then takes that name: a full disk, a crash or a second writer leaves what was there before, or a whole file.
// What is no regular file (a device, a pipe, a descriptor as /dev/stdout) has no name to take: it is written to.
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

namespace keeler {

/// The descriptor of this process that a name means, through any links: 1 of /dev/stdout, 3 of /dev/fd/3.
std::optional<int> descriptor_named(const std::filesystem::path& name);

/// Whether output under this name is written to what is there, and does not replace it.
bool is_stream(const std::filesystem::path& name);

/// Refuses a stream for a `format` that goes back in what it has written. Throws UsageError.
void refuse_stream(const std::filesystem::path& name, const std::string& format);

/// A file is NAME.keeler-XXXXXXXXXXXXXXXX.tmp, of random digits, until it is kept, and goes when it is not. It has the
/// permissions of the file that it replaces. While it is written it is locked: what killed writers of the same name
/// left is known by that, and removed first. Links are not followed: a link NAME is replaced, unless it leads to a
/// stream.
class NewFile {
public:
  /// Waits for the reader of a named pipe; so does write(). Throws IoError, Interrupted.
  explicit NewFile(std::filesystem::path file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Adds it at the end. Throws IoError, Interrupted.
  void write(std::span<const std::byte> content);

  /// For formats that go back in what they have written. Precondition: no stream.
  const std::shared_ptr<Descriptor>& descriptor() const { return out_; }

  /// Forces it to disk and gives it its name. Throws IoError.
  void keep();

private:
  std::filesystem::path file_, temporary_; // temporary_ is empty: a stream, or kept
  std::shared_ptr<Descriptor> out_;
  std::optional<unsigned> replaced_mode_; // permissions of the file that goes
};

/// The name that a file was to get, of the name of one in the making.
std::optional<std::string_view> unfinished_name(std::string_view name);

/// Removes files in the making that belong to this user and that no process writes any more, where `of` accepts the
/// name that they were to get.
void remove_left_overs(const std::filesystem::path& folder, const std::function<bool(std::string_view name)>& of);

} // namespace keeler
