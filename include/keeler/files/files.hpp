// Whole files, read and written so that a name always stands for a complete file: the new content goes to NAME.tmp,
// is forced to disk, and only then takes the name. A full disk or a crash leaves what stood there before.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace keeler {

/// A file in the making, for whoever fills it piece by piece: it is NAME.tmp until it is kept, and goes when it is not.
class NewFile {
public:
  explicit NewFile(std::filesystem::path file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  /// Forces it to disk and gives it its name. Throws IoError.
  void keep();

private:
  std::filesystem::path file_, temporary_;
  bool kept_ = false;
};

/// Writes a file as described above; after a failure neither NAME.tmp nor a changed NAME is left. Throws IoError.
/// A process that sets a file-size limit must ignore SIGXFSZ, else that signal ends it before the error is seen.
void write_file(const std::filesystem::path& file, std::span<const std::byte> content);

/// The same for text.
void write_text(const std::filesystem::path& file, std::string_view text);

/// Before work whose result goes to `output`: throws IoError unless this is a folder that can be written to.
void require_writable_folder(const std::filesystem::path& folder, const std::filesystem::path& output);

/// All bytes of a file. Throws IoError.
std::vector<std::byte> read_file(const std::filesystem::path& file);
std::string read_text(const std::filesystem::path& file);

} // namespace keeler
