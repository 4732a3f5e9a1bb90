// Plays recorded messages onto a link, as if the vehicle were there.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/mavlink/link/link_address.hpp"
#include "flight/playback/playback_clock.hpp"
#include "flight/playback/playback_records.hpp"

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
  /// Called when the link is open, with the actual port.
  std::function<void(const mavlink::LinkAddress&)> opened;
  /// Called after each command.
  std::function<void(const PlaybackClock& clock, std::int64_t position_us)> changed;
};

struct PlaybackSummary {
  std::uint64_t sent = 0;    ///< frames
  std::uint64_t unsent = 0;  ///< frames that no peer took
};

/// Sends the frames at their times, byte by byte; what the other side sends is ignored. A link that
/// fails is opened again after a second. Returns at the end, after kQuit, or when `stop` is set.
/// Errors: as open_byte_link at the start; those of the records.
[[nodiscard]] Result<PlaybackSummary> play_records(PlaybackRecords& records,
                                                   const mavlink::LinkAddress& address,
                                                   const PlaybackOptions& options,
                                                   const PlaybackPorts& ports,
                                                   const std::atomic<bool>& stop);

}  // namespace overfly::flight::playback
