// Division of work among several processes in one folder: each name is claimed by one process at a time. The system
// releases the claims of a process when it ends, also when it is killed.
#pragma once

#include <filesystem>
#include <string>

namespace keeler::batch {

/// A claim is a lock on one byte of a file, at an offset hashed from the name (fcntl(2), "open file description
/// locks"), so no stale claims remain. On a file system without locks every claim is granted.
class Claims {
public:
  /// Opens the file, or creates it. Throws IoError.
  explicit Claims(const std::filesystem::path& file);
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Tries to claim a name without waiting. Returns false if another process or object holds it.
  bool take(const std::string& name);

  /// Claims a name; waits while another process or object holds it.
  void wait_for(const std::string& name);

  /// Releases a claim of this object.
  void release(const std::string& name);

private:
  int descriptor_;
};

} // namespace keeler::batch
