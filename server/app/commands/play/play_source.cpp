#include "server/app/commands/play/play_source.hpp"

#include <cmath>
#include <utility>

#include "core/earth/height_query.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/playback/flight_records.hpp"
#include "flight/playback/link_output.hpp"
#include "flight/playback/tlog_records.hpp"
#include "flight/replay/logged_flight.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_manifest.hpp"
#include "server/record/truth_samples.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace playback = flight::playback;

using flight::mavlink::LinkAddress;

Result<OpenedPlayback> open_frames(const PlayedFile& played, const LinkAddress& link) {
  if (played.origin) {
    return Error{ErrorCode::kInvalidArgument,
                 "--origin: does not apply to the messages of " + played.file.string() +
                     ", which are sent as they are"};
  }
  auto records = playback::TlogRecords::open(played.file);
  if (!records) return records.error();
  return OpenedPlayback{
      playback::link_output(std::make_unique<playback::TlogRecords>(std::move(*records)), link),
      "",
      {}};
}

Error misused(const std::string& option, const PlayedFile& played, const std::string& what) {
  return {ErrorCode::kInvalidArgument,
          option + ": applies to flight logs, and " + played.file.string() + " is " + what};
}

Result<playback::PlayedFlight> open_run_truth(const PlayedFile& played) {
  if (!played.source.empty()) return misused("--source", played, "a run");
  if (played.origin) return misused("--origin", played, "a run");
  const Result<server::ReadManifest> manifest = server::read_run_manifest(played.file);
  if (!manifest) return manifest.error();
  if (Status status = manifest->check(server::ManifestPart::kWorld); !status) {
    return status.error();
  }
  const server::RunManifest& values = manifest->values;
  if (!values.world || !values.world->origin) {
    return Error{ErrorCode::kConflict, played.file.string() + ": the run ended before its flight"};
  }
  auto flown = server::open_recorded_flight(
      server::truth_samples_file(played.file),
      "run " + server::folder_name(played.file) +
          (values.flight ? ": " + values.flight->description : std::string()));
  if (!flown) return flown.error();
  return playback::PlayedFlight{
      std::move(*flown), LocalFrame(*values.world->origin), values.epoch_utc_ns};
}

/// Any frame will do: states become places on the earth again.
LocalFrame frame_of(const PlayedFile& played) {
  return LocalFrame(played.origin.value_or(Geodetic{}));
}

Result<playback::PlayedFlight> open_poses(const PlayedFile& played,
                                          const std::atomic<bool>* cancel) {
  std::error_code failure;
  if (played.file.extension() == ".tlog" || fs::is_empty(played.file, failure)) {
    return Error{
        ErrorCode::kUnreadable,
        played.file.string() + ": holds no poses" +
            (played.file.extension() == ".tlog" ? ": no message of a vehicle is in it" : "")};
  }
  if (!played.source.empty()) return misused("--source", played, "a file of poses");
  if (played.file.extension() != ".csv" && !played.origin) {
    return Error{ErrorCode::kInvalidArgument,
                 played.file.string() +
                     ": the poses count from an origin that the file does not state: must be given "
                     "as --origin LAT,LON,HEIGHT"};
  }
  auto flown = flight::fly_log(played.file, frame_of(played), false, cancel);
  if (!flown) return flown.error();
  playback::PlayedFlight flight{std::move(*flown), frame_of(played), std::nullopt};
  flight.is_placed = played.origin.has_value();
  return flight;
}

Result<playback::PlayedFlight> open_logged(const PlayedFile& played,
                                           const std::atomic<bool>* cancel) {
  flight::LogFlightOptions options;
  options.source = played.source;
  options.local_origin = played.origin;
  options.far_poses = true;
  const FlatGround nowhere(0.0);
  auto flown = flight::fly_flight_log(
      played.file, options, frame_of(played), nowhere, SourcePolicy(), cancel);
  if (!flown) return flown.error();
  // Clocks of ROS count from 1970, those of vehicles from their start.
  constexpr std::int64_t kYear2000UtcNs = 946'684'800 * kNsPerS;
  std::optional<std::int64_t> unix_ns = (*flown)->log_start_ns();
  if (unix_ns && *unix_ns < kYear2000UtcNs) unix_ns.reset();
  playback::PlayedFlight flight{std::move(*flown), frame_of(played), unix_ns};
  flight.is_placed = played.origin.has_value();
  return flight;
}

/// What is flown: the truth of a run, the flight of a log, or poses.
Result<playback::PlayedFlight> open_flight(const PlayedFile& played,
                                           const std::atomic<bool>* cancel) {
  std::error_code ignored;
  if (fs::is_directory(played.file, ignored)) return open_run_truth(played);
  const Result<flight::logs::LogFormat> format = flight::logs::detect_format(played.file);
  if (format) return open_logged(played, cancel);
  const bool other_format = format.error().code == ErrorCode::kUnreadable;
  return other_format ? open_poses(played, cancel) : format.error();
}

/// "map at 47.1, 8.2, 500.0": whoever takes positions in metres needs it.
std::string map_text(const playback::FlightMoments& moments) {
  const Geodetic& origin = moments.map_origin();
  // Without the last digits of the change from radians: 1e-12 deg are 0.1 um.
  const auto degrees = [](double angle_rad) {
    return number_text(std::round(deg_from_rad(angle_rad) * 1e12) / 1e12);
  };
  return "map at " + degrees(origin.lat_rad) + "," + degrees(origin.lon_rad) + "," +
         number_text(origin.alt_ellipsoid_m);
}

}  // namespace

Result<OpenedPlayback> open_playback(const PlayedFile& asked,
                                     const PlaybackTarget& target,
                                     const std::atomic<bool>* cancel) {
  PlayedFile played = asked;
  if (const auto* const link = std::get_if<LinkAddress>(&target)) {
    std::error_code ignored;
    const fs::path messages = server::vehicle_log_file(played.file);
    if (fs::is_directory(played.file, ignored) && fs::exists(messages, ignored)) {
      played.file = messages;
    }
    const Result<flight::logs::LogFormat> format = flight::logs::detect_format(played.file);
    if (played.source.empty() && format && *format == flight::logs::LogFormat::kTlog) {
      return open_frames(played, *link);
    }
  }
  Result<playback::PlayedFlight> flown = open_flight(played, cancel);
  if (!flown) return flown.error();
  flown->rate_hz = played.rate_hz;
  OpenedPlayback opened;
  opened.description = flown->flight->description();
  opened.warnings = flown->flight->warnings();
  if (const auto* const link = std::get_if<LinkAddress>(&target)) {
    auto records = playback::FlightRecords::create(std::move(*flown));
    if (!records) return records.error();
    opened.output = playback::link_output(
        std::make_unique<playback::FlightRecords>(std::move(*records)), *link);
    return opened;
  }
  auto moments = playback::FlightMoments::create(std::move(*flown));
  if (!moments) return moments.error();
  opened.description += ", " + map_text(*moments);
  if (const auto* const ros = std::get_if<playback::RosTarget>(&target)) {
    opened.output = playback::ros_output(std::move(*moments), *ros);
  } else {
    opened.output = playback::lcm_output(std::move(*moments), std::get<LcmTarget>(target).url);
  }
  return opened;
}

}  // namespace overfly::app
