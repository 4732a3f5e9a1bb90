// What is sent of a flight to a client of the Foxglove protocol: its rows, tracks and cameras as
// messages of ROS 2, on the channels that the client subscribed to.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "server/net/foxglove/channels.hpp"
#include "server/net/foxglove/due_rows.hpp"
#include "server/net/foxglove/subscriptions.hpp"
#include "server/net/stream/run_instant.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/ros2/ros2_flight.hpp"
#include "server/ros2/ros2_type.hpp"

namespace overfly::net::foxglove {

/// Uses no clock; sends through the port.
class FlightMessages {
 public:
  /// Poses of a track in one message; longer tracks are thinned out.
  static constexpr std::size_t kPathPoses = 1000;

  /// @param port, subscriptions  must outlive the object
  FlightMessages(std::shared_ptr<const server::RunTimeline> timeline,
                 ViewerPort& port,
                 const Subscriptions& subscriptions);

  /// Takes in what the run has said of itself meanwhile: cameras, origin, Unix time of its start.
  /// @return true if its topics are others now
  bool refresh();
  [[nodiscard]] const FlightNames& names() const { return names_; }
  /// Unix time of an instant of the run. @pre has_epoch()
  [[nodiscard]] std::int64_t utc_ns(std::int64_t t_ns) const { return *epoch_utc_ns_ + t_ns; }
  /// False until the run knows the time of its start.
  [[nodiscard]] bool has_epoch() const { return epoch_utc_ns_.has_value(); }
  /// Errors: kUnsupported for a flight outside the times that messages of ROS 2 can hold.
  [[nodiscard]] Status check_epoch() const;

  [[nodiscard]] const EstimatePlaces& places() const { return places_; }
  void set_places(EstimatePlaces places) { places_ = std::move(places); }

  // Each sends what was subscribed to. @pre has_epoch()
  void send_row(const DueRow& row);
  void send_camera_info(std::size_t camera, std::int64_t t_ns);
  void send_paths(std::int64_t t_ns);
  /// @param points  in the world
  void send_points(std::size_t estimator,
                   std::int64_t t_ns,
                   const std::vector<Eigen::Vector3f>& points);
  /// What a picture's message begins with; the JPEG follows.
  /// @return empty if the picture's channel is not subscribed to
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> picture_head(ChannelKind kind,
                                                                      std::size_t index,
                                                                      std::int64_t t_ns,
                                                                      std::size_t jpeg_bytes) const;

  /// Sends what a channel shows at t, so that it is not empty until the next row.
  void send_present(const Channel& channel, std::int64_t t_ns);

 private:
  using Payload = std::vector<std::uint8_t>;
  /// Makes and sends a message if its channel is subscribed to.
  void send(ChannelKind kind,
            std::size_t index,
            std::int64_t t_ns,
            const std::string& frame,
            const std::function<Payload(const server::Ros2Header&)>& make);
  void send_frame(std::size_t camera, const server::FrameRow& row);
  void send_transforms(std::size_t camera, const server::FrameRow& row);
  void send_fix(ChannelKind kind,
                std::size_t index,
                std::int64_t t_ns,
                const Eigen::Vector3d& p_world);
  void send_estimate(std::size_t estimator, const server::EstimateRow& row);
  void send_transform(std::int64_t t_ns, const std::string& child, const Pose& T_world_child);
  void send_state(std::size_t estimator, const server::EstimateRow& row);
  void send_log(const server::LogRow& row);
  [[nodiscard]] std::optional<Pose> T_world_body(std::size_t estimator,
                                                 const server::EstimateRow& row) const;
  [[nodiscard]] const Pose& T_body_camera(std::size_t estimator) const;
  void send_path(ChannelKind kind, std::size_t index, std::int64_t t_ns);
  [[nodiscard]] std::vector<server::StampedPose> truth_track(std::int64_t t_ns) const;
  [[nodiscard]] std::vector<server::StampedPose> estimated_track(std::size_t estimator,
                                                                 std::int64_t t_ns) const;
  void send_present_rows(std::int64_t t_ns);

  std::shared_ptr<const server::RunTimeline> timeline_;
  ViewerPort& port_;
  const Subscriptions& subscriptions_;
  FlightNames names_;
  std::vector<server::RunCamera> cameras_;
  std::vector<std::size_t> camera_of_;  ///< by estimator
  std::optional<std::int64_t> epoch_utc_ns_;
  std::optional<LocalFrame> world_;
  EstimatePlaces places_;
  /// While only one channel is sent to.
  std::optional<std::pair<ChannelKind, std::size_t>> only_;
};

}  // namespace overfly::net::foxglove
