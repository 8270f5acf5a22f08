// A rank that reports another build of Keeler.
#include <keeler/comm/communicator.hpp>
#include <keeler/core/version.hpp>

// replaces the definitions of keeler_core
std::string keeler::program_version() {
  return "0.0.0";
}
std::string keeler::source_commit() {
  return "0000000";
}
std::string keeler::build_compiler() {
  return "another one";
}
std::string keeler::build_flags() {
  return "others";
}

int main() {
  try {
    keeler::Communicator::launched();
  } catch (const keeler::Error& error) {
    keeler::comm::fail_ranks(error.code());
    return static_cast<int>(error.code());
  }
  keeler::comm::finish_ranks();
  return 0;
}
