#include "access.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

namespace access_test {

using namespace keeler::live_view;

namespace {

constexpr int port = 8123;
const std::string own = "127.0.0.1:8123";

bool admits(const Access& access, const std::string& path, const std::vector<std::string_view>& hosts,
            const std::vector<std::string_view>& origins = {}) {
  return access.admit({.path = path, .hosts = hosts, .origins = origins}).has_value();
}

} // namespace

TEST_CASE("the page has an address with a token of its own") {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) {
    const Access access(port);
    CHECK(access.token().size() == 32);
    CHECK(access.token().find_first_not_of("0123456789abcdef") == std::string::npos);
    CHECK(access.address() == "http://" + own + "/" + access.token() + "/");
    tokens.insert(access.token());
  }
  CHECK(tokens.size() == 100);
}

TEST_CASE("a request with the token and one of the server's names is admitted, and gets what follows the token") {
  const Access access(port);
  const std::string base = "/" + access.token() + "/";
  for (const std::string& host : {own, std::string("localhost:8123")}) {
    CHECK(access.admit({.path = base, .hosts = {host}, .origins = {}}) == "");
    CHECK(access.admit({.path = base + "frame", .hosts = {host}, .origins = {}}) == "frame");
    CHECK(admits(access, base + "stop", {host}, {"http://" + std::string(host)}));
  }
}

TEST_CASE("no other token is admitted") {
  const Access access(port);
  const std::string token = access.token();
  for (std::size_t k = 0; k < token.size(); ++k) {
    std::string wrong = token;
    wrong[k] = wrong[k] == '0' ? '1' : '0';
    CHECK_FALSE(admits(access, "/" + wrong + "/", {own}));
  }
  for (const std::string& path :
       {std::string(), std::string("/"), std::string("//"), "/" + token, token + "/", "/" + token.substr(1) + "/",
        "/" + token.substr(0, 31) + "/", "/" + token + "0/", "//" + token + "/", "/x/" + token + "/",
        "/" + std::string(32, '/') + "/", "/" + std::string(32, '\0') + "/", "/" + Access(port).token() + "/"})
    CHECK_FALSE(admits(access, path, {own}));
}

TEST_CASE("a request that calls the server by another name, or comes from a page of elsewhere, is not admitted") {
  const Access access(port);
  const std::string path = "/" + access.token() + "/";
  for (const std::string_view host :
       {"", "127.0.0.1", "localhost", "127.0.0.1:80", "127.0.0.1:81234", "evil.example:8123",
        "localhost.evil.example:8123", "127.0.0.1:8123.evil.example", "evil.example@127.0.0.1:8123", "[::1]:8123",
        "127.0.0.2:8123", "LOCALHOST:8123", "127.0.0.1:8123 ", "0.0.0.0:8123"})
    CHECK_FALSE(admits(access, path, {host}));
  CHECK_FALSE(admits(access, path, {}));
  CHECK_FALSE(admits(access, path, {own, own}));
  for (const std::string_view origin : {"", "null", "http://evil.example", "https://127.0.0.1:8123", "http://127.0.0.1",
                                        "http://127.0.0.1:8888", "127.0.0.1:8123", "http://127.0.0.1:8123/"})
    CHECK_FALSE(admits(access, path, {own}, {origin}));
  CHECK_FALSE(admits(access, path, {own}, {"http://127.0.0.1:8123", "http://evil.example"}));
}

} // namespace access_test
