// Access to the server of the page: the token in the address, and the names by which a request calls the server.
// Both are decided here, without any library, so that tests can try every case.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace keeler::live_view {

/// What a request says of itself. `hosts` and `origins` hold all values of these headers.
struct Claim {
  std::string_view path; ///< "/TOKEN/frame", without the query
  std::vector<std::string_view> hosts, origins;
};

/// Returns 128 random bits in hexadecimal. Throws Error if the system gives none.
std::string random_token();

class Access {
public:
  /// Draws a token of 128 random bits. Throws Error if the system gives none.
  explicit Access(int port);

  const std::string& token() const { return token_; }
  /// Returns the address of the page.
  std::string address() const;

  /// Returns the path below the token, as "frame". Returns none for a wrong token, for another Host than this server on
  /// the loopback address, for several Hosts, and for an Origin that is not this server. A page of another site says
  /// its own name as Host, even if that name was made to point to this machine (DNS rebinding).
  std::optional<std::string> admit(const Claim& claim) const;

private:
  bool is_own(std::string_view host) const;
  bool has_token(std::string_view path) const;

  std::string token_, by_number_, by_name_; // 127.0.0.1:PORT, localhost:PORT
};

} // namespace keeler::live_view
