// Who of several processes in one folder does what: a name is claimed by one process at a time. The system lets go of
// all claims of a process when it ends, however it ends.
#pragma once

#include <filesystem>
#include <string>

namespace keeler {

/// Claims are locks on single bytes of one file, a byte a name (fcntl(2), "open file description locks"), so that
/// nothing is left behind. On a file system without locks every claim is granted.
class Claims {
public:
  /// Makes the file if it is not there. Throws IoError.
  explicit Claims(const std::filesystem::path& file);
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Whether the name is now this object's: false when another process (or object) has it.
  bool take(const std::string& name);

  /// Waits until the name is this object's.
  void wait_for(const std::string& name);

  void release(const std::string& name);

private:
  int descriptor_;
};

} // namespace keeler
