// Which run each idempotency key gave.
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <optional>
#include <string>
#include <unordered_map>

namespace overfly::engine {

/// Bounded in number and age: the key asked for least lately leaves first. Not thread-safe.
class IdempotencyKeys {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMostKeys = 1000;
  static constexpr std::chrono::hours kOldest{24};

  /// The run that a key gave; empty for an unknown, an empty or a forgotten key.
  [[nodiscard]] std::optional<std::string> run_of(const std::string& key, Time now);
  /// An empty key is none.
  void keep(const std::string& key, const std::string& run_id, Time now);
  /// The run is gone: its key may give another.
  void forget_run(const std::string& run_id);
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::string key;
    std::string run_id;
    Time kept;
  };
  void drop_old(Time now);

  std::list<Entry> entries_;  ///< the one asked for last is in front
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
};

}  // namespace overfly::engine
