#include "server/net/foxglove/flight_messages.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "core/time.hpp"
#include "middleware/ros1/frame_names.hpp"
#include "server/net/foxglove/server_message.hpp"
#include "server/ros2/flight_names.hpp"
#include "server/ros2/ros2_flight.hpp"
#include "server/ros2/ros2_message.hpp"
#include "server/timeline/count_frames.hpp"
#include "server/timeline/estimate_errors.hpp"

namespace overfly::net::foxglove {
namespace {

using server::EstimateRow;
using server::FrameRow;
using server::Ros2Header;
using server::StampedPose;

/// Lines of the log that a new subscription is sent at once.
constexpr std::size_t kPresentLogs = 200;

Eigen::Quaterniond base_attitude(const Pose& T_world_body) {
  return T_world_body.rotation * server::R_body_base();
}

/// Calls `take` with the numbers of at most FlightMessages::kPathPoses rows spread over `rows`, the
/// last one among them: the track ends where the aircraft is.
template <typename Take>
void for_spread_rows(std::size_t rows, const Take& take) {
  const std::size_t most = FlightMessages::kPathPoses;
  const std::size_t step = std::max<std::size_t>((rows + most - 1) / most, 1);
  for (std::size_t i = 0; i < rows; i += step) take(i + step < rows ? i : rows - 1);
}

}  // namespace

FlightMessages::FlightMessages(std::shared_ptr<const server::RunTimeline> timeline,
                               ViewerPort& port,
                               const Subscriptions& subscriptions)
    : timeline_(std::move(timeline)),
      port_(port),
      subscriptions_(subscriptions),
      places_(EstimatePlaces::of(*timeline_, server::kRecordedAlignment)) {}

bool FlightMessages::refresh() {
  const server::RunInfo info = timeline_->info();
  epoch_utc_ns_ = info.epoch_utc_ns;
  const bool begins =
      info.status == server::RunStatus::kQueued || info.status == server::RunStatus::kRunning;
  if (!epoch_utc_ns_ && !begins) epoch_utc_ns_ = 0;  // not in the records of old runs
  if (info.origin) world_ = LocalFrame(*info.origin);
  cameras_ = timeline_->cameras();
  camera_of_.clear();
  for (std::size_t i = 0; i < timeline_->estimators().size(); ++i) {
    const std::size_t camera = server::camera_of_estimator(*timeline_, i);
    camera_of_.push_back(camera < cameras_.size() ? camera : server::kMainCamera);
  }
  FlightNames names = names_of(cameras_, timeline_->estimators());
  if (names == names_) return false;
  names_ = std::move(names);
  return true;
}

Status FlightMessages::check_epoch() const {
  constexpr std::int64_t kLatestNs = std::numeric_limits<std::int32_t>::max() * kNsPerS;
  if (!epoch_utc_ns_ || (*epoch_utc_ns_ >= 0 && *epoch_utc_ns_ <= kLatestNs)) return {};
  return Error{ErrorCode::kUnsupported,
               "epoch_utc_ns = " + std::to_string(*epoch_utc_ns_) +
                   ": messages of ROS 2 hold only times from 1970 to 2038"};
}

void FlightMessages::send(ChannelKind kind,
                          std::size_t index,
                          std::int64_t t_ns,
                          const std::string& frame,
                          const std::function<Payload(const Ros2Header&)>& make) {
  if (only_ && *only_ != std::pair(kind, index)) return;
  const auto subscription = subscriptions_.of(kind, index);
  if (!subscription) return;
  Payload message = data_head(*subscription, utc_ns(t_ns));
  const Payload payload = make({utc_ns(t_ns), frame});
  message.insert(message.end(), payload.begin(), payload.end());
  port_.send_binary(std::move(message));
}

void FlightMessages::send_row(const DueRow& row) {
  if (const auto* frame = std::get_if<FrameRow>(&row.row)) send_frame(row.index, *frame);
  if (const auto* estimate = std::get_if<EstimateRow>(&row.row)) {
    send_estimate(row.index, *estimate);
  }
  if (const auto* line = std::get_if<server::LogRow>(&row.row)) send_log(*line);
}

void FlightMessages::send_frame(std::size_t camera, const FrameRow& row) {
  if (camera >= names_.cameras.size()) return;
  send_transforms(camera, row);
  send(ChannelKind::kCameraTruth,
       camera,
       row.t_ns,
       ros1::kWorldFrame,
       [&](const Ros2Header& header) { return server::ros2_pose(header, row.T_world_camera); });
  if (camera != server::kMainCamera) return;
  send_fix(ChannelKind::kTruthFix, 0, row.t_ns, row.T_world_body.translation);
}

void FlightMessages::send_transforms(std::size_t camera, const FrameRow& row) {
  send_transform(row.t_ns, names_.cameras[camera].frame, row.T_world_camera);
  if (camera != server::kMainCamera) return;
  const Pose T_world_base{base_attitude(row.T_world_body), row.T_world_body.translation};
  send_transform(row.t_ns, ros1::kBodyFrame, T_world_base);
}

void FlightMessages::send_transform(std::int64_t t_ns,
                                    const std::string& child,
                                    const Pose& T_world_child) {
  send(ChannelKind::kTransforms, 0, t_ns, ros1::kWorldFrame, [&](const Ros2Header& header) {
    return server::ros2_transform(header, child, T_world_child);
  });
}

void FlightMessages::send_fix(ChannelKind kind,
                              std::size_t index,
                              std::int64_t t_ns,
                              const Eigen::Vector3d& p_world) {
  if (!world_) return;
  send(kind, index, t_ns, ros1::kBodyFrame, [&](const Ros2Header& header) {
    return server::ros2_fix(header, world_->geodetic_from_world(p_world));
  });
}

std::optional<Pose> FlightMessages::T_world_body(std::size_t estimator,
                                                 const EstimateRow& row) const {
  const auto& place = places_.of_estimator.at(estimator);
  return place ? place->T_world_body(row) : std::nullopt;
}

const Pose& FlightMessages::T_body_camera(std::size_t estimator) const {
  return cameras_.at(camera_of_.at(estimator)).T_body_camera;
}

void FlightMessages::send_estimate(std::size_t estimator, const EstimateRow& row) {
  const std::int64_t t_ns = row.sample.t_ns;
  const FlightNames::Estimate& names = names_.estimates.at(estimator);
  send_state(estimator, row);
  if (row.sample.state != TrackingState::kTracking) return;
  send(ChannelKind::kPose, estimator, t_ns, names.own, [&](const Ros2Header& header) {
    return server::ros2_pose(header, row.sample.T_vo_camera);
  });
  const auto placed = T_world_body(estimator, row);
  if (!placed) return;
  const Pose T_world_camera = *placed * T_body_camera(estimator);
  send_transform(t_ns, names.frame, T_world_camera);
  send(ChannelKind::kWorldPose, estimator, t_ns, ros1::kWorldFrame, [&](const Ros2Header& header) {
    return server::ros2_pose(header, T_world_camera);
  });
  send_fix(ChannelKind::kFix, estimator, t_ns, placed->translation);
}

void FlightMessages::send_state(std::size_t estimator, const EstimateRow& row) {
  const std::string& frame = names_.estimates.at(estimator).frame;
  send(ChannelKind::kState, estimator, row.sample.t_ns, frame, [&](const Ros2Header& header) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    server::Ros2EstimateState state{to_string(row.sample.state),
                                    row.latency_ms,
                                    row.sample.map_id,
                                    kNone,
                                    kNone,
                                    kNone,
                                    kNone,
                                    kNone};
    if (const auto& place = places_.of_estimator.at(estimator)) {
      if (const auto error = server::errors_of(*timeline_, estimator, {row}, *place).front()) {
        state.error_m = error->position_m();
        state.error_along_m = error->position.along_m;
        state.error_across_m = error->position.across_m;
        state.error_up_m = error->position.up_m;
        state.error_rotation_deg = deg_from_rad(error->rotation_rad);
      }
    }
    return server::ros2_estimate_state(header, state);
  });
}

void FlightMessages::send_log(const server::LogRow& row) {
  send(ChannelKind::kLog, 0, row.t_ns, "", [&](const Ros2Header& header) {
    const std::string source = row.source.empty() ? "overfly" : row.source;
    return server::ros2_log({header.stamp_ns, row.level, source, row.text});
  });
}

void FlightMessages::send_camera_info(std::size_t camera, std::int64_t t_ns) {
  if (camera >= cameras_.size() || camera >= names_.cameras.size()) return;
  send(ChannelKind::kCameraInfo,
       camera,
       t_ns,
       names_.cameras[camera].frame,
       [&](const Ros2Header& header) {
         return server::ros2_camera_info(header, cameras_[camera].model);
       });
}

void FlightMessages::send_paths(std::int64_t t_ns) {
  send_path(ChannelKind::kTruthPath, 0, t_ns);
  for (std::size_t i = 0; i < names_.estimates.size(); ++i) {
    send_path(ChannelKind::kPath, i, t_ns);
  }
}

void FlightMessages::send_path(ChannelKind kind, std::size_t index, std::int64_t t_ns) {
  send(kind, index, t_ns, ros1::kWorldFrame, [&](const Ros2Header& header) {
    std::vector<StampedPose> poses =
        kind == ChannelKind::kTruthPath ? truth_track(t_ns) : estimated_track(index, t_ns);
    for (StampedPose& pose : poses) pose.pose.rotation = base_attitude(pose.pose);
    return server::ros2_path(header, poses);
  });
}

std::vector<StampedPose> FlightMessages::truth_track(std::int64_t t_ns) const {
  const std::size_t rows = server::count_frames(
      *timeline_, server::kMainCamera, [&](const FrameRow& row) { return row.t_ns <= t_ns; });
  std::vector<StampedPose> poses;
  for_spread_rows(rows, [&](std::size_t i) {
    for (const FrameRow& row : timeline_->frames(i, 1)) {
      poses.push_back({utc_ns(row.t_ns), row.T_world_body});
    }
  });
  return poses;
}

std::vector<StampedPose> FlightMessages::estimated_track(std::size_t estimator,
                                                         std::int64_t t_ns) const {
  const std::size_t rows =
      server::count_rows(timeline_->estimate_count(estimator), [&](std::size_t i) {
        const auto row = timeline_->estimates(estimator, i, 1);
        return !row.empty() && row.front().sample.t_ns <= t_ns;
      });
  std::vector<StampedPose> poses;
  for_spread_rows(rows, [&](std::size_t i) {
    for (const EstimateRow& row : timeline_->estimates(estimator, i, 1)) {
      const auto placed = T_world_body(estimator, row);
      if (placed) poses.push_back({utc_ns(row.sample.t_ns), *placed});
    }
  });
  return poses;
}

void FlightMessages::send_points(std::size_t estimator,
                                 std::int64_t t_ns,
                                 const std::vector<Eigen::Vector3f>& points) {
  send(ChannelKind::kPoints, estimator, t_ns, ros1::kWorldFrame, [&](const Ros2Header& header) {
    return server::ros2_points(header, points);
  });
}

std::optional<std::vector<std::uint8_t>> FlightMessages::picture_head(
    ChannelKind kind, std::size_t index, std::int64_t t_ns, std::size_t jpeg_bytes) const {
  const auto subscription = subscriptions_.of(kind, index);
  if (!subscription) return std::nullopt;
  const bool is_debug = kind == ChannelKind::kDebugImage;
  const std::size_t camera = is_debug ? camera_of_.at(index) : index;
  const std::string& frame = names_.cameras.at(camera).frame;
  std::vector<std::uint8_t> head = data_head(*subscription, utc_ns(t_ns));
  const auto message = server::ros2_jpeg_head({utc_ns(t_ns), frame}, jpeg_bytes);
  head.insert(head.end(), message.begin(), message.end());
  return head;
}

void FlightMessages::send_present(const Channel& channel, std::int64_t t_ns) {
  only_ = {channel.kind, channel.index};
  send_present_rows(t_ns);
  send_paths(t_ns);
  only_.reset();
}

void FlightMessages::send_present_rows(std::int64_t t_ns) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const auto row = timeline_->frame_at(t_ns, i);
    if (!row) continue;
    send_frame(i, *row);
    // Of the image that is shown: the topic stays in order of time.
    send_camera_info(i, row->t_ns);
  }
  for (std::size_t i = 0; i < names_.estimates.size(); ++i) {
    if (const auto row = timeline_->estimate_at(i, t_ns)) send_estimate(i, *row);
  }
  if (only_ != std::pair(ChannelKind::kLog, std::size_t{0})) return;
  const std::size_t lines = server::count_rows(timeline_->log_count(), [&](std::size_t i) {
    const auto row = timeline_->logs(i, 1);
    return !row.empty() && row.front().t_ns <= t_ns;
  });
  const std::size_t sent = std::min(lines, kPresentLogs);
  for (const server::LogRow& row : timeline_->logs(lines - sent, sent)) send_log(row);
}

}  // namespace overfly::net::foxglove
