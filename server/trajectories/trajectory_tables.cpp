#include "server/trajectories/trajectory_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/measure/bounded_series.hpp"
#include "core/time.hpp"
#include "evaluation/window_errors.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Each interval keeps two points for each channel, and the first and the last point stay.
BoundedSeries series_of(std::size_t channels, std::size_t points) {
  return {channels, (points - 2) / (2 * channels)};
}

/// Leaves out rows with values that JSON cannot represent: poses may have any size.
void add_if_finite(BoundedSeries& series, const SeriesPoint& point) {
  const bool finite = std::all_of(
      point.values.begin(), point.values.end(), [](double value) { return std::isfinite(value); });
  if (finite) series.add(point);
}

Json columns_of_series(const BoundedSeries& series, const std::vector<std::string>& columns) {
  const std::vector<SeriesPoint> points = series.points();
  Json times = Json::array();
  for (const SeriesPoint& point : points) times.push_back(s_from_ns(point.t_ns));
  Json table = {{"t_s", std::move(times)}};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Json values = Json::array();
    for (const SeriesPoint& point : points) values.push_back(point.values.at(i));
    table[columns[i]] = std::move(values);
  }
  return table;
}

/// Positions and attitudes of poses in the world.
class PoseTables {
 public:
  PoseTables(const Pose& T_body_pose, std::size_t points)
      : R_pose_body_(T_body_pose.rotation.conjugate()),
        positions_(series_of(3, points)),
        attitudes_(series_of(3, points)) {}

  void add(std::int64_t t_ns, const Pose& T_world_pose) {
    const Eigen::Vector3d& p = T_world_pose.translation;
    add_if_finite(positions_, {t_ns, {p.x(), p.y(), p.z()}});
    const RollPitchYaw angles = attitude_from(T_world_pose.rotation * R_pose_body_);
    add_if_finite(attitudes_,
                  {t_ns,
                   {deg_from_rad(angles.roll_rad),
                    deg_from_rad(angles.pitch_rad),
                    deg_from_rad(angles.yaw_rad)}});
  }
  [[nodiscard]] Json json() const {
    return {{"positions", columns_of_series(positions_, {"x_m", "y_m", "z_m"})},
            {"attitudes", columns_of_series(attitudes_, {"roll_deg", "pitch_deg", "yaw_deg"})}};
  }

 private:
  Eigen::Quaterniond R_pose_body_;
  BoundedSeries positions_;
  BoundedSeries attitudes_;
};

}  // namespace

Json pose_tables(const ServedTrajectory& trajectory, std::size_t points) {
  PoseTables tables(trajectory.T_body_pose, points);
  for (const StampedPose& stamped : trajectory.file.trajectory.poses()) {
    tables.add(stamped.t_ns, stamped.pose);
  }
  return tables.json();
}

Json error_tables(const FileScore& score,
                  evaluation::AlignmentMode mode,
                  const Pose& T_body_pose,
                  std::size_t points) {
  const evaluation::AlignmentScore& alignment = score.score.alignments.at(mode);
  const std::vector<evaluation::AxisError>& axes = score.axis_errors.at(mode);
  const bool rotations = !alignment.rotation_errors_deg.empty();
  PoseTables poses(T_body_pose, points);
  BoundedSeries by_axis = series_of(3, points);
  BoundedSeries sizes = series_of(rotations ? 2 : 1, points);
  BoundedSeries scale = series_of(1, points);
  BoundedSeries relative = series_of(2, points);
  std::vector<std::optional<evaluation::PosePair>> pairs;
  for (std::size_t i = 0; i < score.matches.size(); ++i) {
    const std::int64_t t_ns = score.matches[i].t_ns;
    const Pose T_world_pose = alignment.S_world_vo * score.matches[i].T_vo_camera;
    poses.add(t_ns, T_world_pose);
    pairs.push_back(evaluation::PosePair{
        0, score.matches[i].T_world_camera, T_world_pose, score.matches[i].detour_m});
    if (const auto error = evaluation::scale_error_at(pairs, i)) {
      add_if_finite(scale, {t_ns, {100.0 * *error, 0.0, 0.0}});
    }
    add_if_finite(by_axis, {t_ns, {axes[i].along_m, axes[i].across_m, axes[i].up_m}});
    add_if_finite(sizes,
                  {t_ns,
                   {alignment.position_errors_m[i],
                    rotations ? alignment.rotation_errors_deg[i] : 0.0,
                    0.0}});
  }
  const auto along = evaluation::relative_errors_along(pairs);
  for (std::size_t i = 0; i < along.size(); ++i) {
    if (!along[i]) continue;
    const double rotation_rad = evaluation::kErrorWindow_m * along[i]->rotation_rad_m;
    add_if_finite(
        relative,
        {score.matches[i].t_ns, {100.0 * along[i]->translation, deg_from_rad(rotation_rad), 0.0}});
  }
  Json tables = poses.json();
  tables["axis_errors"] = columns_of_series(by_axis, {"along_m", "across_m", "up_m"});
  tables["errors"] = rotations ? columns_of_series(sizes, {"position_m", "rotation_deg"})
                               : columns_of_series(sizes, {"position_m"});
  tables["scale"] = columns_of_series(scale, {"scale_percent"});
  tables["relative"] = columns_of_series(relative, {"relative_percent", "relative_deg"});
  return tables;
}

}  // namespace overfly::server
