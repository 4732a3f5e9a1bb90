// The topics of one estimator.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "middleware/ros1/master_watch.hpp"
#include "middleware/ros1/node.hpp"
#include "middleware/ros1/types.hpp"
#include "vo_bridges/ros1/ros1_options.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::ros1 {

/// Handlers for incoming messages; called on the topics' thread until the topics are destroyed.
struct TopicHandlers {
  /// A pose as published; empty if it is invalid (not finite, or a bad quaternion).
  /// @param covariance  as published, 36 values; empty if the message has none
  std::function<void(
      std::int64_t stamp_ns, const std::optional<Pose>& pose, std::span<const double> covariance)>
      pose;
  std::function<void(const ImageMessage::ConstPtr& image)> debug_image;
};

class Topics {
 public:
  /// Errors: kConflict if another estimator of this process uses a topic; kInternal naming a topic
  /// that ROS rejects.
  [[nodiscard]] static Result<std::unique_ptr<Topics>> open(Node& node,
                                                            const Ros1EstimatorOptions& options,
                                                            TopicHandlers handlers,
                                                            std::shared_ptr<LineLog> log);
  ~Topics();
  Topics(const Topics&) = delete;
  Topics& operator=(const Topics&) = delete;

  /// Publishes time and calibration; late subscribers receive the last calibration.
  void publish_calibration(const VoFrame& frame, std::int64_t stamp_ns);
  /// Publishes time, calibration, samples of sensors, then the image: a node that has the image has
  /// the others.
  void publish(const VoFrame& frame, std::int64_t stamp_ns);
  /// Does nothing without publish_tf.
  void publish_estimate(const Pose& T_vo_camera, std::int64_t stamp_ns);

  [[nodiscard]] bool somebody_sees_images() const { return images_.getNumSubscribers() > 0; }
  [[nodiscard]] bool somebody_sees_calibration() const { return infos_.getNumSubscribers() > 0; }
  [[nodiscard]] bool somebody_tells_poses() const { return poses_.getNumPublishers() > 0; }
  /// Also true if no debug image is configured.
  [[nodiscard]] bool somebody_draws_debug_images() const {
    return !debug_images_ || debug_images_.getNumPublishers() > 0;
  }
  /// As known to the master, with leading slash.
  [[nodiscard]] std::string image_topic() const { return images_.getTopic(); }
  [[nodiscard]] std::string pose_topic() const { return poses_.getTopic(); }
  /// The topics to register with the master.
  [[nodiscard]] std::vector<TopicRegistration> registrations() const;

 private:
  Topics(Node& node,
         const Ros1EstimatorOptions& options,
         TopicHandlers handlers,
         std::shared_ptr<LineLog> log);
  Status claim_all();
  Status advertise_all();
  Status subscribe_all();
  template <typename M>
  Status advertise(const std::string& topic,
                   ros::Publisher& publisher,
                   bool latched = false,
                   int queue_size = 0);
  Status advertise_sensors();
  /// @param offset_ns  ROS time minus the flight's
  void publish_samples(const SensorSamples& samples, std::int64_t offset_ns);
  template <typename M, typename Handle>
  Status subscribe(const std::string& topic, Handle handle, ros::Subscriber& subscriber);
  Status subscribe_pose();

  Node& node_;
  const Ros1EstimatorOptions options_;
  const TopicHandlers handlers_;
  const std::shared_ptr<LineLog> log_;
  std::vector<OwnTopic> claimed_;
  bool has_clock_ = false;
  std::vector<TopicRegistration> registrations_;
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::Publisher images_, infos_, clock_, transforms_;
  std::map<std::string, ros::Publisher> sensors_;  ///< by topic
  ros::Subscriber poses_, debug_images_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace overfly::ros1
