// A small HTTP server on the loopback address, for one page. It checks access (access.hpp) and limits what a connection
// takes; the content comes from a function. One thread serves all connections and waits for none of them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace keeler::live_view {

/// A request that was admitted.
struct Request {
  std::string path; ///< below the token: "" is the page
  std::map<std::string, std::string> query;
  bool is_command = false; ///< POST, else GET
};

/// Its answer: `head` and then `body`, which is shared, since large ones go to several pages.
struct Reply {
  std::string type; ///< as "text/html; charset=utf-8"
  std::string head;
  std::shared_ptr<const std::string> body;
  std::string content_policy; ///< of a page: its Content-Security-Policy
};

class PageServer {
public:
  /// Returns what a request gets; none: there is nothing of that name. Called in the server's thread only.
  using Answer = std::function<std::optional<Reply>(const Request&)>;

  /// Serves from now on, at a port of the system's choice if `port` is 0. Throws Error when the port cannot be had, or
  /// the program was built without the library for it.
  PageServer(Answer answer, int port);
  /// Ends the thread and all connections. In a forked process, which has no such thread, does nothing.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Returns the address of the page, with the token.
  std::string address() const;

private:
  class Connections;
  std::unique_ptr<Connections> connections_;
};

} // namespace keeler::live_view
