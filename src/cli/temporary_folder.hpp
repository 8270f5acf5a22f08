// A folder that only this user can read, removed at the end.
#pragma once

#include <filesystem>
#include <string>

namespace keeler::cli {

class TemporaryFolder {
public:
  /// Makes it where the system keeps temporary files. Throws IoError.
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace keeler::cli
