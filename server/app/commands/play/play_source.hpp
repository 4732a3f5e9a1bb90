// What `overfly play` plays, and where: the frames of a telemetry log, or the flight of any other
// recording.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"
#include "flight/mavlink/link/link_address.hpp"
#include "flight/playback/playback_output.hpp"
#include "flight/playback/topics/topic_outputs.hpp"

namespace overfly::app {

struct PlayedFile {
  /// A flight log, a pose file, or the folder of a run.
  std::filesystem::path file;
  std::string source;              ///< of the positions of a flight log, as `log info` lists them
  std::optional<Geodetic> origin;  ///< of positions that count from an origin which is not stated
  double rate_hz = 50.0;           ///< of the messages of a flight
};

struct LcmTarget {
  std::string url;
};
using PlaybackTarget =
    std::variant<flight::mavlink::LinkAddress, LcmTarget, flight::playback::RosTarget>;

struct OpenedPlayback {
  std::unique_ptr<flight::playback::PlaybackOutput> output;  ///< not open yet
  std::string description;  ///< of a flight; empty for a telemetry log, whose frames are sent
  std::vector<std::string> warnings;
};

/// Onto a link, a .tlog without `source` and the folder of a live run are played byte by byte. Of
/// everything else, and onto LCM and ROS, the recommended truth is flown.
/// Errors: kInvalidArgument for options that do not apply; as TlogRecords::open, fly_flight_log,
/// fly_log, read_run_manifest, open_recorded_flight, FlightRecords::create and
/// FlightMoments::create.
[[nodiscard]] Result<OpenedPlayback> open_playback(const PlayedFile& played,
                                                   const PlaybackTarget& target,
                                                   const std::atomic<bool>* cancel);

}  // namespace overfly::app
