// The viewers of a run and the cost of serving them.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

namespace overfly::server {

/// Thread-safe.
class Audience {
 public:
  /// One viewer; it counts as watching while the object lives.
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

  enum class Kind { kCamera, kDebug, kScene, kDepth, kError };
  /// @param cpu_s  processor time of the thread that made it
  void picture_made(Kind kind, double cpu_s);

  /// `viewers` in total, `most_at_once`, `viewer_s` (viewing time of all, present viewers
  /// included), `pictures.{camera, debug, scene, depth, error}` and `cpu_s` (processor time spent
  /// on the pictures).
  [[nodiscard]] nlohmann::json summary() const;

 private:
  mutable std::mutex mutex_;
  int came_ = 0;
  int seated_ = 0;
  int most_ = 0;
  double left_viewer_s_ = 0.0;     ///< of viewers who have left
  double seated_since_sum_s_ = 0;  ///< sum of the arrival times of the present viewers
  std::int64_t pictures_[5] = {};
  double cpu_s_ = 0.0;
};

}  // namespace overfly::server
