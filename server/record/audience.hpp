// Who watches a run, and what that costs.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

namespace overfly::engine {

/// Thread-safe.
class Audience {
 public:
  /// One viewer, as long as it lives.
  class Seat {
   public:
    explicit Seat(std::shared_ptr<Audience> audience);
    ~Seat();
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;

   private:
    std::shared_ptr<Audience> audience_;
    std::chrono::steady_clock::time_point since_;
  };

  enum class Kind { kCamera, kDebug, kScene };
  /// @param cpu_s  of the thread that made it
  void picture_made(Kind kind, double cpu_s);

  /// `viewers` that came, `most_at_once`, `viewer_s` (of all together, those who stay included),
  /// `pictures.{camera, debug, scene}` and `cpu_s` of making them.
  [[nodiscard]] nlohmann::json summary() const;

 private:
  mutable std::mutex mutex_;
  int came_ = 0;
  int seated_ = 0;
  int most_ = 0;
  double left_viewer_s_ = 0.0;     ///< of those who have left
  double seated_since_sum_s_ = 0;  ///< over those who stay: when they came
  std::int64_t pictures_[3] = {};
  double cpu_s_ = 0.0;
};

}  // namespace overfly::engine
