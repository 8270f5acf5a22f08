#include "signals.hpp"

#include <csignal>

#include <unistd.h>

namespace keeler {
namespace {

RunRequests requests; // a handler can reach nothing else

void give_up(int) {
  requests.give_up = true;
}

void ask_to_stop(int signal) {
  if (requests.stop.exchange(true)) {
    give_up(signal);
    std::signal(signal, SIG_DFL); // one more ends the program
  }
  alarm(requests.patience_s);
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
  install(SIGALRM, give_up);
  install(SIGUSR2, ask_for_snapshot);
  return requests;
}

} // namespace keeler
