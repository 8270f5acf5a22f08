// Replaces page_server.cpp where libmicrohttpd is missing.
#include "page_server.hpp"

#include <keeler/core/error.hpp>

namespace keeler::live_view {

class PageServer::Connections {};

PageServer::PageServer(Answer, int) {
  throw Error(ExitCode::run_time,
              "this program was built without libmicrohttpd, so it has no view; install "
              "libmicrohttpd-dev, run cmake again and build (keeler report makes a page without it)");
}

PageServer::~PageServer() = default;

std::string PageServer::address() const {
  return {};
}

} // namespace keeler::live_view
