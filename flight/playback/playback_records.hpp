// What a playback sends: MAVLink frames at their times.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/result.hpp"

namespace overfly::flight::playback {

/// Frames in the order of their times, as often as wanted.
class PlaybackRecords {
 public:
  struct Record {
    std::int64_t t_us = 0;                ///< since the start of the recording, >= 0
    std::span<const std::uint8_t> frame;  ///< valid until the next call
  };

  virtual ~PlaybackRecords() = default;

  /// The next record; empty at the end. Times never decrease. Errors: those of the recording.
  [[nodiscard]] virtual Result<std::optional<Record>> next() = 0;
  /// Continues with the first record at or after a time. Errors: those of the recording.
  virtual Status seek(std::int64_t t_us) = 0;

  /// Time of the last record.
  [[nodiscard]] virtual std::int64_t duration_us() const = 0;
  [[nodiscard]] virtual std::uint64_t count() const = 0;
};

}  // namespace overfly::flight::playback
