// The WebSocket connections of a server, so that each can be notified of a shutdown.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

namespace overfly::net {

/// Thread-safe.
class SessionRegistry {
 public:
  /// Asks a connection to end; must return before the connection ends.
  using GoAway = std::function<void()>;

  /// A connection that is added during shutdown is asked to go at once.
  /// @return its number, for remove()
  std::uint64_t add(const GoAway& go_away) {
    const std::lock_guard lock(mutex_);
    if (closed_) go_away();
    sessions_.emplace(++last_, go_away);
    return last_;
  }

  void remove(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    sessions_.erase(number);
    if (sessions_.empty()) empty_.notify_all();
  }

  /// Asks all to go and waits until they have. @return false if some remain after `patience`
  bool close_all(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    closed_ = true;
    for (const auto& [number, go_away] : sessions_) go_away();
    return empty_.wait_for(lock, patience, [&] { return sessions_.empty(); });
  }

 private:
  std::mutex mutex_;
  std::condition_variable empty_;
  std::map<std::uint64_t, GoAway> sessions_;
  std::uint64_t last_ = 0;
  bool closed_ = false;
};

}  // namespace overfly::net
