// How many connections a server has, of each kind, and which one goes when there are too many.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace overfly::net {

/// What a connection does. The kinds keep apart: strangers cannot take the places of those who were
/// let in, and viewers cannot take those of requests.
enum class ConnectionPhase {
  kStranger,   ///< nothing of it was let in yet
  kIdle,       ///< HTTP: between two requests
  kReceiving,  ///< HTTP: sends a request that was let in
  kAnswering,  ///< HTTP: waits for the server
  kSending,    ///< HTTP: takes an answer
  kViewer,     ///< a WebSocket
  kClosing,    ///< was asked to end; counts no more
};

struct ConnectionLimits {
  std::size_t max_strangers = 64;  ///< beyond: the one that is here longest is closed
  std::size_t max_http = 128;    ///< beyond: the one that is idle longest is closed; none idle: 503
  std::size_t max_viewers = 64;  ///< beyond: 503
};

/// Thread-safe.
class ConnectionTable {
 public:
  /// Asks a connection to end; must not end it before it returns.
  using Close = std::function<void()>;

  /// A connection's entry; leaves the table with its owner.
  class Place {
   public:
    Place(ConnectionTable& table, std::uint64_t number) : table_(table), number_(number) {}
    ~Place() { table_.remove(number_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    /// @return false where there is no room, or the connection was asked to end: it stays what it
    /// was
    [[nodiscard]] bool enter(ConnectionPhase phase) { return table_.enter(number_, phase); }
    [[nodiscard]] std::uint64_t number() const { return number_; }

   private:
    ConnectionTable& table_;
    std::uint64_t number_;
  };

  explicit ConnectionTable(const ConnectionLimits& limits) : limits_(limits) {}

  /// A new connection, a stranger. There is always room: the oldest stranger makes it.
  [[nodiscard]] std::unique_ptr<Place> add(Close close);
  [[nodiscard]] std::size_t count(ConnectionPhase phase) const;

 private:
  struct Entry {
    ConnectionPhase phase = ConnectionPhase::kStranger;
    std::uint64_t since = 0;  ///< order in which the phases began
    Close close;
  };
  bool enter(std::uint64_t number, ConnectionPhase phase);
  void remove(std::uint64_t number);
  [[nodiscard]] std::size_t& counted(ConnectionPhase phase);
  void change(Entry* entry, ConnectionPhase phase);
  bool close_oldest(ConnectionPhase phase);

  const ConnectionLimits limits_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Entry> entries_;
  std::array<std::size_t, 7> counts_{};
  std::atomic<std::uint64_t> last_number_{0};
  std::uint64_t last_since_ = 0;
};

}  // namespace overfly::net
