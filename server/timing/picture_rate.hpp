// Limits the rate of pictures for viewers to the time that real-time flights leave free.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

namespace overfly::server {

/// Monitors the time to spare in the flights' frames and moves the limit in steps. The limit goes
/// down if a frame was missed, or if more than half of the frames of a window had little time left.
/// It goes up after a period in which pictures were drawn without harm. Each step up that proves
/// too much doubles that period. Thread-safe; the caller provides the time.
class PictureRate {
 public:
  /// Call when a real-time flight begins; the limit starts at kFirstHz.
  void flight_began(std::int64_t now_ns);
  void flight_ended();
  /// Call when a frame was made and handed over.
  /// @param left_ns  time until the next frame is due; negative = late
  void frame_made(std::int64_t now_ns, std::int64_t period_ns, std::int64_t left_ns);
  /// Call when a frame was skipped because its time had passed.
  void frame_missed(std::int64_t now_ns);
  /// Call when a picture for a viewer was made.
  void picture_made();

  [[nodiscard]] bool flying() const;
  /// Maximum rate of each picture stream [Hz]; empty = no limit: no real-time flight, or enough
  /// time for all pictures.
  [[nodiscard]] std::optional<double> limit_hz() const;

  static constexpr double kFirstHz = 5.0;
  static constexpr double kLeastHz = 1.0;

 private:
  struct Window {
    std::int64_t begin_ns = 0;
    int frames = 0;
    int tight = 0;  ///< frames with little time left
    int missed = 0;
    int pictures = 0;
  };
  void close_window(std::int64_t now_ns);
  void step_down();
  void step_up();

  mutable std::mutex mutex_;
  int flights_ = 0;
  std::size_t step_ = 0;
  Window window_;
  int calm_windows_ = 0;
  int windows_to_wait_ = 0;  ///< calm windows required before a step up
  int windows_since_step_up_ = 0;
};

}  // namespace overfly::server
