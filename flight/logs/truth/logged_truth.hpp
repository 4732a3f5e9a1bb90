// Reads the samples of a log's truth: the positions and attitudes of the chosen streams.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/local_grid.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Attitudes this much before and after a position can be interpolated at its time.
inline constexpr std::int64_t kMaxAttitudeStepNs = 1'000'000'000;

struct TrajectoryRequest {
  std::string source;  ///< as choose_truth()
  /// Limits by the vehicle's clock [ns], within the slice of the log; all of it without them.
  std::optional<std::int64_t> from_ns;
  std::optional<std::int64_t> to_ns;
  /// Added to the times of attitudes [ns].
  std::int64_t attitude_offset_ns = 0;
  /// Attitudes are read from so much before to so much after the time asked for [ns].
  std::int64_t attitude_margin_ns = kMaxAttitudeStepNs;
  /// A trajectory is to have the attitudes themselves as well.
  bool keep_attitudes = false;
};

/// What the samples of a log's truth are.
struct LoggedTruth {
  bool georeferenced = false;
  HeightDatum height = HeightDatum::kMeanSeaLevel;  ///< of georeferenced positions
  std::string position_source;
  std::string attitude_source;
  /// The run of the vehicle's clock that the samples are of: as LogTime::boot.
  std::uint32_t boot = 0;
  /// What was left out, with counts.
  std::vector<std::string> warnings;
};

/// Receives the samples of a truth in the order of the file.
class TruthSampleSink {
 public:
  virtual ~TruthSampleSink() = default;
  /// Called once, before the first sample: at most so many positions follow.
  virtual void expect(std::size_t positions) = 0;
  /// Where local positions count from, until the next origin. Positions before the first one count
  /// from it as well.
  virtual void local_origin(const LocalOrigin& origin) = 0;
  /// @param value  as the PositionKind of its stream
  virtual void position(const LogTime& time, const Eigen::Vector3d& value) = 0;
  virtual void attitude(const LogTime& time, const Eigen::Quaterniond& R_ned_body) = 0;
};

/// Reads the positions in the time asked for, and the attitudes in it and its margins.
/// Errors: as open_log and choose_truth; kUnreadable if there are no positions in the time asked
/// for, or no attitudes of the same vehicle.
[[nodiscard]] Result<LoggedTruth> read_truth_samples(const OpenedLog& log,
                                                     const TrajectoryRequest& request,
                                                     TruthSampleSink& sink,
                                                     const std::atomic<bool>* cancel);

/// What turns the heights of a source into heights above the ellipsoid [m]: the geoid's height, or
/// 0 for those that are. Errors: kInvalidArgument if a height of the geoid is given for heights
/// above the ellipsoid.
[[nodiscard]] Result<double> separation_of(HeightDatum height,
                                           const std::string& source,
                                           double geoid_separation_m);

}  // namespace overfly::flight::logs
