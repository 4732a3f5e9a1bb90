// The topics of one estimator.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vo_bridges/ros1/ros1_estimator.hpp"
#include "vo_bridges/ros1/ros1_node.hpp"
#include "vo_bridges/ros1/ros1_types.hpp"
#include "vo_bridges/ros1/ros1_watch.hpp"

namespace overfly::ros1 {

/// What comes in; called from the topics' thread, until they are destroyed.
struct TopicHandlers {
  /// A pose as it was published; empty for one that is none (not finite, a bad quaternion).
  std::function<void(std::int64_t stamp_ns, const std::optional<Pose>& pose)> pose;
  std::function<void(const ImageMessage::ConstPtr& image)> debug_image;
};

class Topics {
 public:
  /// Errors: kConflict for a topic that another estimator of this process has; kInternal naming a
  /// topic that ROS refuses.
  [[nodiscard]] static Result<std::unique_ptr<Topics>> open(Node& node,
                                                            const Ros1EstimatorOptions& options,
                                                            TopicHandlers handlers,
                                                            std::shared_ptr<LineLog> log);
  ~Topics();
  Topics(const Topics&) = delete;
  Topics& operator=(const Topics&) = delete;

  /// Time and calibration; who comes later is told the last calibration.
  void publish_calibration(const VoFrame& frame, std::int64_t stamp_ns);
  /// Time, calibration, then the image: who has the image has the others.
  void publish(const VoFrame& frame, std::int64_t stamp_ns);
  void publish_reset();
  /// Nothing without publish_tf.
  void publish_estimate(const Pose& T_vo_camera, std::int64_t stamp_ns);

  [[nodiscard]] bool somebody_sees_images() const { return images_.getNumSubscribers() > 0; }
  [[nodiscard]] bool somebody_sees_calibration() const { return infos_.getNumSubscribers() > 0; }
  [[nodiscard]] bool somebody_tells_poses() const { return poses_.getNumPublishers() > 0; }
  /// True also where no debug image is asked for.
  [[nodiscard]] bool somebody_draws_debug_images() const {
    return !debug_images_ || debug_images_.getNumPublishers() > 0;
  }
  /// As the master knows them, with their slash.
  [[nodiscard]] std::string image_topic() const { return images_.getTopic(); }
  [[nodiscard]] std::string pose_topic() const { return poses_.getTopic(); }
  /// As the master shall know them.
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
  Status advertise(const std::string& topic, ros::Publisher& publisher, bool latched = false);
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
  ros::Publisher images_, infos_, clock_, resets_, transforms_;
  ros::Subscriber poses_, debug_images_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace overfly::ros1
