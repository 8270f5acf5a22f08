#include <keeler/core/version.hpp>

#include "build_info.hpp"
#include "commit.hpp"

namespace keeler {

std::string program_version() {
  return build_info::version;
}

std::string source_commit() {
  return build_info::commit;
}

std::string build_compiler() {
  return build_info::compiler;
}

std::string build_flags() {
  return build_info::flags;
}

} // namespace keeler
