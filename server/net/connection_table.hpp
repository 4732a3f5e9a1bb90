// Limits the number of a server's connections of each kind, and chooses which one to close.
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

/// What a connection is doing. The kinds are counted separately: clients without a token cannot
/// take the places of authorised ones, and viewers cannot take those of requests.
enum class ConnectionPhase {
  kStranger,   ///< no request of it was authorised yet
  kIdle,       ///< HTTP: between two requests
  kReceiving,  ///< HTTP: receives an authorised request
  kAnswering,  ///< HTTP: the server is working on the answer
  kSending,    ///< HTTP: sends an answer
  kViewer,     ///< a WebSocket
  kOnlooker,   ///< a WebSocket of a client that may change nothing
  kClosing,    ///< was asked to end; not counted any more
};

struct ConnectionLimits {
  std::size_t max_strangers = 64;  ///< beyond: the oldest one is closed
  std::size_t max_http = 128;      ///< beyond: the one idle longest is closed; if none is idle: 503
  /// WebSockets; beyond: 503. An eighth of them is kept for clients that may change something.
  std::size_t max_viewers = 64;
};

/// Thread-safe.
class ConnectionTable {
 public:
  /// Asks a connection to end; must return before the connection ends.
  using Close = std::function<void()>;

  /// A connection's entry; removed from the table by its destructor.
  class Place {
   public:
    Place(ConnectionTable& table, std::uint64_t number) : table_(table), number_(number) {}
    ~Place() { table_.remove(number_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    /// @return false if there is no room, or if the connection was asked to end; its phase then
    /// does not change
    [[nodiscard]] bool enter(ConnectionPhase phase) { return table_.enter(number_, phase); }
    [[nodiscard]] std::uint64_t number() const { return number_; }

   private:
    ConnectionTable& table_;
    std::uint64_t number_;
  };

  explicit ConnectionTable(const ConnectionLimits& limits) : limits_(limits) {}

  /// Adds a new connection as a stranger. Always succeeds; the oldest stranger is closed if needed.
  [[nodiscard]] std::unique_ptr<Place> add(Close close);
  [[nodiscard]] std::size_t count(ConnectionPhase phase) const;
  /// @param phase  kViewer or kOnlooker
  [[nodiscard]] bool has_room_for(ConnectionPhase phase) const;

 private:
  struct Entry {
    ConnectionPhase phase = ConnectionPhase::kStranger;
    std::uint64_t since = 0;  ///< order in which the phases began
    Close close;
  };
  bool enter(std::uint64_t number, ConnectionPhase phase);
  void remove(std::uint64_t number);
  [[nodiscard]] std::size_t& counted(ConnectionPhase phase);
  [[nodiscard]] bool is_full_for(ConnectionPhase phase) const;  ///< @pre mutex_ is held
  void change(Entry* entry, ConnectionPhase phase);
  bool close_oldest(ConnectionPhase phase);

  const ConnectionLimits limits_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Entry> entries_;
  std::array<std::size_t, 8> counts_{};
  std::atomic<std::uint64_t> last_number_{0};
  std::uint64_t last_since_ = 0;
};

}  // namespace overfly::net
