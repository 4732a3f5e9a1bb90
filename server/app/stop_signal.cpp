#include "server/app/stop_signal.hpp"

#include <csignal>

namespace overfly::app {
namespace {

std::atomic<bool> stop_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void on_signal(int signal) {
  if (stop_wanted.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  stop_wanted.notify_all();
}

}  // namespace

const std::atomic<bool>& catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A closed pipe is reported as the write's error instead.
  std::signal(SIGPIPE, SIG_IGN);
  return stop_wanted;
}

void wait_for_stop_signal() { stop_wanted.wait(false); }

}  // namespace overfly::app
