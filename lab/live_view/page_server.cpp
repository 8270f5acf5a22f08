#include "page_server.hpp"

#include "access.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <new>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace keeler::live_view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned max_connections = 64;
constexpr std::size_t connection_bytes = 16384; // for a request's lines
constexpr int unread_bytes = 1 << 20;           // that the system keeps for a client that does not read
constexpr unsigned idle_s = 10;
// Limits on the time until the first whole request of a connection, and until the whole answer to each further one. A
// limit on idle time alone would not do: a client may send or read a byte now and then.
constexpr auto first_request = std::chrono::seconds(5), next_request = std::chrono::seconds(20);
constexpr std::uint64_t turn_ms = 100;

struct Connection {
  int socket = -1;
  Clock::time_point since = Clock::now();
  bool has_asked = false;
};

MHD_Result collect(void* into, MHD_ValueKind, const char*, const char* value) {
  static_cast<std::vector<std::string_view>*>(into)->emplace_back(value ? value : "");
  return MHD_YES;
}

MHD_Result collect_query(void* into, MHD_ValueKind, const char* key, const char* value) {
  static_cast<std::map<std::string, std::string>*>(into)->emplace(key, value ? value : "");
  return MHD_YES;
}

struct NamedValues {
  const char* name;
  std::vector<std::string_view>* values;
};

MHD_Result collect_named(void* into, MHD_ValueKind kind, const char* key, const char* value) {
  const auto& wanted = *static_cast<const NamedValues*>(into);
  return strcasecmp(key, wanted.name) == 0 ? collect(wanted.values, kind, key, value) : MHD_YES;
}

std::vector<std::string_view> header_values(MHD_Connection* connection, const char* name) {
  std::vector<std::string_view> values;
  NamedValues wanted{name, &values};
  MHD_get_connection_values(connection, MHD_HEADER_KIND, collect_named, &wanted);
  return values;
}

// Returns true if a request announces content. No request of the page has any.
bool has_content(MHD_Connection* connection) {
  for (const std::string_view length : header_values(connection, MHD_HTTP_HEADER_CONTENT_LENGTH))
    if (length != "0")
      return true;
  return !header_values(connection, MHD_HTTP_HEADER_TRANSFER_ENCODING).empty();
}

// Sends an answer of these parts, and releases them after the last byte.
MHD_Result send(MHD_Connection* connection, unsigned status, Reply reply) {
  auto* const kept = new Reply(std::move(reply));
  std::array<MHD_IoVec, 2> parts{};
  unsigned count = 0;
  for (const std::string* part : {static_cast<const std::string*>(&kept->head), kept->body.get()})
    if (part && !part->empty())
      parts[count++] = {part->data(), part->size()};
  MHD_Response* const response = MHD_create_response_from_iovec(
      parts.data(), count, [](void* all) { delete static_cast<Reply*>(all); }, kept);
  if (!response) {
    delete kept;
    return MHD_NO;
  }
  const auto add = [&](const char* name, const std::string& value) {
    MHD_add_response_header(response, name, value.c_str());
  };
  add(MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  add("Cross-Origin-Resource-Policy", "same-origin");
  if (!kept->type.empty())
    add(MHD_HTTP_HEADER_CONTENT_TYPE, kept->type);
  if (!kept->content_policy.empty())
    add("Content-Security-Policy", kept->content_policy);
  const MHD_Result queued = MHD_queue_response(connection, status, response);
  MHD_destroy_response(response);
  return queued;
}

} // namespace

class PageServer::Connections {
public:
  Connections(Answer answer, int port);
  ~Connections();
  std::string address() const { return access_->address(); }
  bool is_own_process() const { return process_ == getpid(); }

private:
  void serve();
  void cut_late_ones();
  MHD_Result respond(MHD_Connection* connection, const char* url, const char* method);

  static MHD_Result on_request(void* self, MHD_Connection* connection, const char* url, const char* method,
                               const char* version, const char* content, std::size_t* content_size, void** state);
  static void on_connection(void* self, MHD_Connection* connection, void** state,
                            MHD_ConnectionNotificationCode change);
  static void on_answered(void* self, MHD_Connection* connection, void** state, MHD_RequestTerminationCode how);

  Answer answer_;
  std::map<MHD_Connection*, Connection> open_;
  MHD_Daemon* daemon_ = nullptr;
  std::optional<Access> access_;
  std::atomic<bool> ends_ = false;
  pid_t process_ = getpid();
  std::thread thread_;
};

PageServer::Connections::Connections(Answer answer, int port) : answer_(std::move(answer)) {
  assert(port >= 0 && port < 65536);
  sockaddr_in loopback{};
  loopback.sin_family = AF_INET;
  loopback.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  loopback.sin_port = htons(static_cast<std::uint16_t>(port));
  daemon_ = MHD_start_daemon(MHD_USE_AUTO, 0, nullptr, nullptr, &on_request, this, MHD_OPTION_SOCK_ADDR,
                             reinterpret_cast<sockaddr*>(&loopback), MHD_OPTION_CONNECTION_LIMIT, max_connections,
                             MHD_OPTION_CONNECTION_MEMORY_LIMIT, connection_bytes, MHD_OPTION_CONNECTION_TIMEOUT,
                             idle_s, MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_NOTIFY_CONNECTION, &on_connection,
                             this, MHD_OPTION_NOTIFY_COMPLETED, &on_answered, this, MHD_OPTION_END);
  if (!daemon_)
    throw Error(ExitCode::run_time,
                port > 0
                    ? fmt::format("no view at port {} ({}); give another --port, or none", port, std::strerror(errno))
                    : fmt::format("no view: no port of this machine can be had ({})", std::strerror(errno)));
  access_.emplace(MHD_get_daemon_info(daemon_, MHD_DAEMON_INFO_BIND_PORT)->port);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before); // signals are for the threads that compute
  thread_ = std::thread([this] { serve(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

PageServer::Connections::~Connections() {
  ends_ = true;
  thread_.join();
  MHD_stop_daemon(daemon_);
}

void PageServer::Connections::serve() {
  set_threads(1); // of loops in this thread: the others are for the run
  while (!ends_) {
    MHD_run_wait(daemon_, turn_ms);
    cut_late_ones();
  }
}

void PageServer::Connections::cut_late_ones() {
  const Clock::time_point now = Clock::now();
  for (auto& [connection, state] : open_)
    if (state.socket >= 0 && now - state.since > (state.has_asked ? next_request : first_request)) {
      const linger at_once{.l_onoff = 1, .l_linger = 0}; // drop what the client has not read
      setsockopt(state.socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
      shutdown(state.socket, SHUT_RDWR); // libmicrohttpd closes it
      state.socket = -1;
    }
}

void PageServer::Connections::on_connection(void* self, MHD_Connection* connection, void**,
                                            MHD_ConnectionNotificationCode change) {
  auto& open = static_cast<Connections*>(self)->open_;
  if (change != MHD_CONNECTION_NOTIFY_STARTED) {
    open.erase(connection);
    return;
  }
  try {
    open[connection] = {};
  } catch (const std::bad_alloc&) {
    return; // it may stay as long as it likes
  }
  const int socket = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
  setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &unread_bytes, sizeof unread_bytes);
  open[connection].socket = socket;
}

void PageServer::Connections::on_answered(void* self, MHD_Connection* connection, void** state,
                                          MHD_RequestTerminationCode) {
  *state = nullptr;
  auto& open = static_cast<Connections*>(self)->open_;
  if (const auto found = open.find(connection); found != open.end()) {
    found->second.since = Clock::now();
    found->second.has_asked = true;
  }
}

MHD_Result PageServer::Connections::on_request(void* self, MHD_Connection* connection, const char* url,
                                               const char* method, const char*, const char*, std::size_t* content_size,
                                               void** state) {
  *content_size = 0;
  try {
    if (has_content(connection)) // answered before the content comes: then libmicrohttpd closes the connection
      return send(connection, MHD_HTTP_NOT_FOUND, {});
    if (!*state) { // the header alone; answered at the next call, so that the connection stays
      *state = self;
      return MHD_YES;
    }
    return static_cast<Connections*>(self)->respond(connection, url, method);
  } catch (...) { // no memory; libmicrohttpd, which is in C, cannot pass it on
    return MHD_NO;
  }
}

MHD_Result PageServer::Connections::respond(MHD_Connection* connection, const char* url, const char* method) {
  const bool get = std::strcmp(method, MHD_HTTP_METHOD_GET) == 0;
  const bool post = std::strcmp(method, MHD_HTTP_METHOD_POST) == 0;
  try {
    const std::optional<std::string> path =
        access_->admit({.path = url,
                        .hosts = header_values(connection, MHD_HTTP_HEADER_HOST),
                        .origins = header_values(connection, MHD_HTTP_HEADER_ORIGIN)});
    if (path && (get || post)) {
      Request request{.path = *path, .query = {}, .is_command = post};
      MHD_get_connection_values(connection, MHD_GET_ARGUMENT_KIND, collect_query, &request.query);
      if (std::optional<Reply> reply = answer_(request))
        return send(connection, MHD_HTTP_OK, std::move(*reply));
    }
    return send(connection, MHD_HTTP_NOT_FOUND, {});
  } catch (...) { // as a snapshot that cannot be read: said in the page
    return send(
        connection, MHD_HTTP_INTERNAL_SERVER_ERROR,
        {.type = "text/plain; charset=utf-8", .head = error_at_hand().what(), .body = {}, .content_policy = {}});
  }
}

PageServer::PageServer(Answer answer, int port)
    : connections_(std::make_unique<Connections>(std::move(answer), port)) {}

PageServer::~PageServer() {
  if (!connections_->is_own_process())
    connections_.release(); // NOLINT(bugprone-unused-return-value): its thread is in another process
}

std::string PageServer::address() const {
  return connections_->address();
}

} // namespace keeler::live_view
