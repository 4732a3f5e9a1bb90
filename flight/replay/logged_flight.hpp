// Flies a flight log over a world: at its own place, or moved to another.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "core/motion/truth_source.hpp"
#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "flight/smoothing/smooth_motion.hpp"

namespace overfly::flight {

struct PlaceInWorld {
  double east_m = 0.0;
  double north_m = 0.0;
};
struct PlaceOnEarth {
  double lat_rad = 0.0;
  double lon_rad = 0.0;
};

/// Where a flight is moved to. The whole flight is moved and turned as one: its shape, its climbs
/// and its attitudes relative to the horizon stay.
struct Rebase {
  enum class Point {
    kStart,   ///< the first position
    kCentre,  ///< the centre of the flight's extent to the east and north
  };
  Point point = Point::kCentre;
  std::variant<PlaceInWorld, PlaceOnEarth> at;
  /// The smallest height above the ground, which decides the height of the flight; (0, 10000].
  double lowest_agl_m = 100.0;
  double turn_rad = 0.0;  ///< clockwise seen from above
};

struct LogFlightOptions {
  std::string source;  ///< as logs::choose_truth()
  /// By the vehicle's clock; the whole flight without them.
  std::optional<double> from_s;
  std::optional<double> to_s;
  /// Empty: positions by cubic Hermite splines through the logged ones, rotations by SLERP between
  /// the logged attitudes at their own times.
  std::optional<smoothing::SmoothingOptions> smooth;
  /// Added to the times of the attitudes of a flight that is not smoothed.
  double time_offset_s = 0.0;
  /// Height of the geoid above the ellipsoid: logs have heights above mean sea level. Empty: 0, and
  /// a flight at its own place is warned of.
  std::optional<double> geoid_separation_m;
  /// Height of the geoid above the ellipsoid at a place [m], for that warning; none without it.
  std::function<double(const Geodetic& place)> sea_level_m;
  std::optional<Rebase> rebase;
  /// Where positions count from if the log does not state it; east, north, up from there. Not for
  /// smoothed flights.
  std::optional<Geodetic> local_origin;
  /// Flies poses more than kFarthestFromMiddleM from the middle of the flight as well: for uses
  /// that draw nothing there.
  bool far_poses = false;
};

/// Farther away a pose of a flight that is not smoothed must be damaged.
inline constexpr double kFarthestFromMiddleM = 1e6;

/// Whether fly_flight_log() can fly a file: it is a flight log, not a file of poses.
[[nodiscard]] bool is_flight_log(const std::filesystem::path& file);

/// Time 0 is the first pose. The flight's `warnings` report what the log left out, and jumps.
/// @param frame    of the world
/// @param ground   of the world; used by a rebase only
/// @param sources  which files the log may name
/// Errors: as open_log, choose_truth, read_log_trajectory and smooth_log; kUnsupported if the log
/// does not state where its positions are and no origin is given, kInvalidArgument if both do;
/// kUnreadable if the flight has less than 2 poses, or one is too far away: names its stream and
/// time.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_flight_log(
    const std::filesystem::path& file,
    const LogFlightOptions& options,
    const LocalFrame& frame,
    const HeightQuery& ground,
    const SourcePolicy& sources,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight
