#include "access.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>

#include <sys/random.h>

namespace keeler::live_view {

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error(ExitCode::run_time,
                fmt::format("no view: the system gives no random numbers for its address ({})", std::strerror(errno)));
  std::string token;
  for (const unsigned char byte : bytes)
    token += fmt::format("{:02x}", byte);
  return token;
}

Access::Access(int port)
    : token_(random_token()), by_number_(fmt::format("127.0.0.1:{}", port)),
      by_name_(fmt::format("localhost:{}", port)) {
  assert(port > 0);
}

std::string Access::address() const {
  return fmt::format("http://{}/{}/", by_number_, token_);
}

bool Access::is_own(std::string_view host) const {
  return host == by_number_ || host == by_name_;
}

// Compares all characters in any case, so that the time does not tell how many are right.
bool Access::has_token(std::string_view path) const {
  if (path.size() < token_.size() + 2 || path.front() != '/' || path[token_.size() + 1] != '/')
    return false;
  unsigned char difference = 0;
  for (std::size_t k = 0; k < token_.size(); ++k)
    difference = static_cast<unsigned char>(difference | (path[k + 1] ^ token_[k]));
  return difference == 0;
}

std::optional<std::string> Access::admit(const Claim& claim) const {
  constexpr std::string_view scheme = "http://";
  const auto is_own_origin = [&](std::string_view origin) {
    return origin.starts_with(scheme) && is_own(origin.substr(scheme.size()));
  };
  if (claim.hosts.size() != 1 || !is_own(claim.hosts.front()) ||
      !std::all_of(claim.origins.begin(), claim.origins.end(), is_own_origin) || !has_token(claim.path))
    return std::nullopt;
  return std::string(claim.path.substr(token_.size() + 2));
}

} // namespace keeler::live_view
