// How often pictures for viewers may be drawn beside flights in real time: from what they leave.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

namespace overfly::engine {

/// Watches how much time the flights' frames have left, and moves a limit in steps: down when a
/// frame came late or few had time to spare, up again after a while in which pictures were drawn
/// and did no harm. Each step up that was one too many doubles that while. Thread-safe; the caller
/// gives the clock.
class PictureRate {
 public:
  /// A flight in real time begins; the limit starts at kFirstHz.
  void flight_began(std::int64_t now_ns);
  void flight_ended();
  /// A frame is made and handed over. @param left_ns  until the next one is due; negative = too
  /// late
  void frame_made(std::int64_t now_ns, std::int64_t period_ns, std::int64_t left_ns);
  /// A frame was not made, since its time had passed.
  void frame_missed(std::int64_t now_ns);
  /// A picture for a viewer was made.
  void picture_made();

  [[nodiscard]] bool flying() const;
  /// Of each stream of pictures [Hz]; empty = none: nothing flies in real time, or there is time
  /// for all.
  [[nodiscard]] std::optional<double> limit_hz() const;

  static constexpr double kFirstHz = 5.0;
  static constexpr double kLeastHz = 1.0;

 private:
  struct Window {
    std::int64_t begin_ns = 0;
    int frames = 0;
    int tight = 0;  ///< with little time left
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
  int windows_to_wait_ = 0;  ///< of calm, before a step up
  int windows_since_step_up_ = 0;
};

}  // namespace overfly::engine
