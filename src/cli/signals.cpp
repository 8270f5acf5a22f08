#include "signals.hpp"

#include <atomic>
#include <csignal>
#include <ctime>

#include <unistd.h>

namespace keeler::cli {
namespace {

// Global, since a signal handler has no other access.
runs::RunRequests requests;
std::atomic<double> first_stop_s = 0.0;

constexpr double one_request_s = 0.25;
constexpr int stops[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void give_up(int) {
  requests.give_up = true;
}

void ask_to_stop(int signal) {
  if (!requests.stop.exchange(true)) {
    first_stop_s = now_s();
  } else if (now_s() - first_stop_s > one_request_s) {
    give_up(signal);
    std::signal(signal, SIG_DFL); // a further one ends the program
  }
  alarm(requests.stop_timeout_s);
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

// Blocks or unblocks the handled signals; `how` is SIG_BLOCK or SIG_UNBLOCK.
void mask_signals(int how) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : stops)
    sigaddset(&set, signal);
  sigaddset(&set, SIGUSR2);
  sigprocmask(how, &set, nullptr);
}

} // namespace

void hold_signals() {
  mask_signals(SIG_BLOCK);
}

void release_signals() {
  mask_signals(SIG_UNBLOCK);
}

runs::RunRequests& requests_from_signals() {
  for (const int signal : stops)
    install(signal, ask_to_stop);
  install(SIGALRM, give_up);
  install(SIGUSR2, ask_for_snapshot);
  Interruptible::waits_end_by(requests.stop);
  return requests;
}

} // namespace keeler::cli
