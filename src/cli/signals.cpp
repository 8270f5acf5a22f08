#include "signals.hpp"

#include <csignal>

namespace keeler {
namespace {

RunRequests requests; // a handler can reach nothing else

void ask_to_stop(int signal) {
  requests.stop = true;
  std::signal(signal, SIG_DFL); // the second one ends the program
}

void ask_for_snapshot(int) {
  requests.snapshot = true;
}

void install(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

} // namespace

RunRequests& requests_from_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1})
    install(signal, ask_to_stop);
  install(SIGUSR2, ask_for_snapshot);
  return requests;
}

} // namespace keeler
