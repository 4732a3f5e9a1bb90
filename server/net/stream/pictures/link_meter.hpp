// Reduces pictures to what the way to a client and its browser can carry. Pure: the caller provides
// the time.
#pragma once

#include <cstdint>

namespace overfly::net {

/// Watches how long pictures wait for the client to show the ones before. While they wait for a
/// large part of the time, they are reduced step by step; when they hardly wait any more, they are
/// restored, with longer and longer pauses before a step back that proved too early. Once that step
/// holds, the pauses are short again.
class LinkMeter {
 public:
  /// By how much pictures are reduced: 0 = not at all.
  static constexpr int kMostReduction = 4;

  /// To be called whenever something has changed, and regularly while pictures move.
  /// @param moving  pictures are to be sent one after another
  /// @param blocked  one of them has to wait for the client
  void note(bool moving, bool blocked, std::int64_t now_ns);
  [[nodiscard]] int reduction() const { return reduction_; }
  /// Whether the client, not the server, limits the rate of pictures.
  [[nodiscard]] bool tight() const { return reduction_ > 0; }

 private:
  void close_window(std::int64_t now_ns);

  int reduction_ = 0;
  bool moving_ = false;
  bool blocked_ = false;
  std::int64_t noted_ns_ = 0;
  std::int64_t window_began_ns_ = 0;
  std::int64_t moving_ns_ = 0;   ///< in the window
  std::int64_t blocked_ns_ = 0;  ///< likewise
  int calm_windows_ = 0;
  int windows_to_wait_ = 0;  ///< before a step back to `too_early_at_` or less
  int too_early_at_ = -1;    ///< reduction after the last step back that was too early
  int windows_since_restored_ = 0;
};

/// How a picture is reduced at a step.
struct Reduction {
  int quality_less = 0;
  int halvings = 0;
};
[[nodiscard]] Reduction reduction_at(int step);

}  // namespace overfly::net
