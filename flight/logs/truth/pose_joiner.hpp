// Joins positions with attitudes to poses while both are read.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flight/logs/local_grid.hpp"
#include "flight/logs/log_pose.hpp"
#include "flight/logs/truth/logged_truth.hpp"

namespace overfly::flight::logs {

/// Keeps the poses, and of the samples only those whose poses are not known yet: attitudes may
/// come up to 2 s out of order (BootClock).
///
/// A run of the clock is a boot; samples of different runs are not joined.
class PoseJoiner final : public TruthSampleSink {
 public:
  /// @param keep_attitudes  for take_attitudes()
  explicit PoseJoiner(bool keep_attitudes = false) : keep_attitudes_(keep_attitudes) {}

  void expect(std::size_t positions) override { expected_ = positions; }
  void local_origin(const LocalOrigin& origin) override;
  void position(const LogTime& time, const Eigen::Vector3d& value) override;
  void attitude(const LogTime& time, const Eigen::Quaterniond& R_ned_body) override;

  struct JoinedPoses {
    std::uint32_t boot = 0;  ///< the run with the most positions
    std::vector<LogPose> poses;
  };
  /// The poses of the run with the most positions, and what was left out.
  /// @pre there was a position; nothing follows
  [[nodiscard]] JoinedPoses take_poses(std::vector<std::string>& warnings);
  /// The attitudes of the run with the most positions, times strictly increasing. Before the first
  /// pose and after the last one there is only the next one.
  /// @pre after take_poses(), which returned poses
  [[nodiscard]] std::vector<LogAttitude> take_attitudes() { return std::move(kept_attitudes_); }

 private:
  struct Position {
    std::int64_t t_ns = 0;
    std::uint32_t origin = 0;  ///< 1 + index of its origin; 0: none yet
    Eigen::Vector3d value;
  };
  struct Run {
    std::size_t positions = 0;
    std::optional<std::int64_t> last_position_ns;
    std::vector<Position> waiting;
    std::vector<LogAttitude> attitudes;  ///< in the order of the file since the last join
    std::vector<LogAttitude> used;       ///< those before `attitudes`, if they are kept
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
  /// Keeps what take_attitudes() gives. @pre all is joined
  void keep_attitudes_of(Run& run);
  void add_pose(Run& run, const Position& position, const Eigen::Quaterniond& R_ned_body);

  bool keep_attitudes_;
  std::vector<LogAttitude> kept_attitudes_;
  std::size_t expected_ = 0;   ///< number of positions for which memory is reserved
  std::size_t positions_ = 0;  ///< in all runs
  std::map<std::uint32_t, Run> runs_;
  std::vector<LocalOrigin> origins_;
};

}  // namespace overfly::flight::logs
