// A recorded flight that is played.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/earth/geodesy.hpp"
#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "core/text/number_text.hpp"

namespace overfly::flight::playback {

inline constexpr double kSlowestMessagesHz = 1.0;
inline constexpr double kFastestMessagesHz = 1000.0;

struct PlayedFlight {
  /// Its length is known, and it may be asked for earlier times again: flights of logs, poses and
  /// runs.
  std::unique_ptr<TruthSource> flight;
  LocalFrame frame{Geodetic{}};  ///< of its states
  /// UTC since 1970 at the flight's start, where it is known.
  std::optional<std::int64_t> unix_at_start_ns;
  double rate_hz = 50.0;  ///< of the messages
  /// The recording, or its user, says where the frame's origin is; else it is any place.
  bool is_placed = true;
};

/// Errors: kInvalidArgument.
[[nodiscard]] inline Status check_message_rate(double rate_hz) {
  if (rate_hz >= kSlowestMessagesHz && rate_hz <= kFastestMessagesHz) return {};
  return Error{ErrorCode::kInvalidArgument,
               "rate = " + number_text(rate_hz) + " Hz: must be in [1, 1000]"};
}

}  // namespace overfly::flight::playback
