// Plays a recording onto an output at its own times, as if the vehicle were there.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/playback/playback_clock.hpp"
#include "flight/playback/playback_output.hpp"

namespace overfly::flight::playback {

inline constexpr double kSlowest = 0.01;
inline constexpr double kFastest = 1000.0;

struct PlaybackOptions {
  double speed = 1.0;             ///< [kSlowest, kFastest]
  std::int64_t from_us = 0;       ///< position of the start
  bool repeat = false;            ///< starts again at the end
  bool wait_for_listener = true;  ///< starts when there is somebody to send to
};

/// What a user asks for during a playback.
struct PlaybackCommand {
  enum class Kind { kPause, kPlay, kSpeed, kSeek, kQuit };
  Kind kind = Kind::kPlay;
  double value = 0.0;  ///< of kSpeed; of kSeek [s]
};
/// "pause", "play", "speed X", "seek S", "quit". Errors: kInvalidArgument listing these.
[[nodiscard]] Result<PlaybackCommand> parse_playback_command(const std::string& line);

struct PlaybackPorts {
  std::function<PlaybackClock::TimePoint()> now;
  /// Commands since the last call.
  std::function<std::vector<PlaybackCommand>()> commands;
  /// Called when the output is open.
  std::function<void(const PlaybackOutput&)> opened;
  /// Called after each command.
  std::function<void(const PlaybackClock& clock, std::int64_t position_us)> changed;
};

/// Sends the messages at their times. Returns at the end, after kQuit, or when `stop` is set.
/// Errors: those of the output.
[[nodiscard]] Result<PlaybackSummary> play(PlaybackOutput& output,
                                           const PlaybackOptions& options,
                                           const PlaybackPorts& ports,
                                           const std::atomic<bool>& stop);

}  // namespace overfly::flight::playback
