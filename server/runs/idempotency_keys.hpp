// Maps idempotency keys to the runs that they started.
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <optional>
#include <string>
#include <unordered_map>

namespace overfly::server {

/// A client's key for a request, which may be sent again.
struct IdempotencyKey {
  std::string text{};           ///< empty = none
  std::size_t body_digest = 0;  ///< of the request's body: another body is another request
};

/// Bounded in number and age; the least recently used key is evicted first. Not thread-safe.
class IdempotencyKeys {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMostKeys = 1000;
  static constexpr std::chrono::hours kOldest{24};

  struct Start {
    std::string run_id;
    std::size_t body_digest;  ///< of the request that started it
  };
  /// What a key started; empty for an unknown, an empty or an evicted key.
  [[nodiscard]] std::optional<Start> start_of(const std::string& key, Time now);
  /// Does nothing for an empty key.
  void keep(const IdempotencyKey& key, const std::string& run_id, Time now);
  /// Call when the run is deleted: its key may then start another.
  void forget_run(const std::string& run_id);
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    IdempotencyKey key;
    std::string run_id;
    Time kept;
  };
  void drop_old(Time now);

  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
};

}  // namespace overfly::server
