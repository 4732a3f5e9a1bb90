// What `overfly play` plays: the frames of a telemetry log, or the flight of any other recording.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"
#include "flight/playback/playback_records.hpp"

namespace overfly::app {

struct PlayedFile {
  /// A flight log, a pose file, or the folder of a run.
  std::filesystem::path file;
  std::string source;              ///< of the positions of a flight log, as `log info` lists them
  std::optional<Geodetic> origin;  ///< of positions that count from an origin which is not stated
  double rate_hz = 50.0;           ///< of the messages of a flight
};

struct OpenedPlayback {
  std::unique_ptr<flight::playback::PlaybackRecords> records;
  std::string description;  ///< of a flight; empty for a telemetry log, whose frames are sent
  std::vector<std::string> warnings;
};

/// A .tlog without `source`, and the folder of a live run, are played byte by byte; of everything
/// else the recommended truth is flown.
/// Errors: kInvalidArgument for options that do not apply; as TlogRecords::open, fly_flight_log,
/// fly_log, read_run_manifest, open_recorded_flight and FlightRecords::create.
[[nodiscard]] Result<OpenedPlayback> open_playback(const PlayedFile& played,
                                                   const std::atomic<bool>* cancel);

}  // namespace overfly::app
