#include "temporary_folder.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace keeler::cli {

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::error_code error;
  std::string pattern = (std::filesystem::temp_directory_path(error) / (name + "-XXXXXX")).string();
  if (error || !mkdtemp(pattern.data()))
    throw IoError(fmt::format("cannot make a temporary folder ({}); set TMPDIR to a folder that can be written",
                              error ? error.message() : std::strerror(errno)));
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

} // namespace keeler::cli
