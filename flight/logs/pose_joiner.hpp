// Joins positions with attitudes to poses while both are read.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flight/logs/local_grid.hpp"
#include "flight/logs/log_pose.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// An attitude further away than this says nothing about a position.
inline constexpr std::int64_t kMaxAttitudeStepNs = 1'000'000'000;

/// Keeps the poses, and of the samples only those whose poses cannot be told yet: attitudes may
/// come up to 2 s out of order (BootClock).
///
/// A run of the clock is a boot; samples of different runs are not joined.
class PoseJoiner {
 public:
  /// @param expected  number of positions for which memory is reserved
  explicit PoseJoiner(std::size_t expected) : expected_(expected) {}

  void position(const LogTime& time, const Eigen::Vector3d& value);
  void attitude(const LogTime& time, const Eigen::Quaterniond& R_ned_body);
  /// Where local positions count from, until the next origin. Positions before the first one count
  /// from it as well.
  void local_origin(const LocalOrigin& origin);

  /// Number of positions in all runs.
  [[nodiscard]] std::size_t positions() const { return positions_; }
  [[nodiscard]] bool has_origin() const { return !origins_.empty(); }

  /// The poses of the run with the most positions, and what was left out.
  /// @pre positions() > 0; nothing follows
  [[nodiscard]] std::vector<LogPose> take_poses(std::vector<std::string>& warnings);

 private:
  struct Position {
    std::int64_t t_ns = 0;
    std::uint32_t origin = 0;  ///< 1 + index of its origin; 0: none yet
    Eigen::Vector3d value;
  };
  struct Attitude {
    std::int64_t t_ns = 0;
    Eigen::Quaternionf R_ned_body;
  };
  struct Run {
    std::size_t positions = 0;
    std::optional<std::int64_t> last_position_ns;
    std::vector<Position> waiting;
    std::vector<Attitude> attitudes;  ///< in the order of the file since the last join
    std::int64_t latest_attitude_ns = 0;
    std::vector<LogPose> poses;
    std::size_t without_origin = 0;  ///< poses in front that are still local
    std::size_t out_of_order = 0;
    std::size_t without_attitude = 0;
    std::size_t doubled = 0;
    std::size_t join_at = 0;  ///< number of samples at which the next join is worth its time
  };

  Run& run_of(std::uint32_t boot);
  void join_some(Run& run);
  /// Makes the poses of all waiting positions up to a time.
  void join(Run& run, std::int64_t until_ns);
  void add_pose(Run& run, const Position& position, const Eigen::Quaterniond& R_ned_body);

  std::size_t expected_;
  std::size_t positions_ = 0;
  std::map<std::uint32_t, Run> runs_;
  std::vector<LocalOrigin> origins_;
};

}  // namespace overfly::flight::logs
