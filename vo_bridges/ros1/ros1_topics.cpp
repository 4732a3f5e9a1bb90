#include "vo_bridges/ros1/ros1_topics.hpp"

#include <ros/single_subscriber_publisher.h>

#include <utility>

#include "core/barrier.hpp"
#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/sensor_messages.hpp"
#include "vo_bridges/ros1/own_topics.hpp"

namespace overfly::ros1 {
namespace {

constexpr const char* kClock = "/clock";
constexpr const char* kTransforms = "/tf";
constexpr std::string_view kSensors = "/sensors";  ///< of with_each_message
/// Samples come in bursts, with each image: more than ten seconds of an IMU at 200 Hz.
constexpr int kSensorQueue = 2500;

std::int64_t ns_of(const ros::Time& time) { return static_cast<std::int64_t>(time.toNSec()); }

bool same_frame(const std::string& a, const std::string& b) { return bare_name(a) == bare_name(b); }

}  // namespace

Topics::Topics(Node& node,
               const Ros1EstimatorOptions& options,
               TopicHandlers handlers,
               std::shared_ptr<LineLog> log)
    : node_(node), options_(options), handlers_(std::move(handlers)), log_(std::move(log)) {
  handle_.setCallbackQueue(&queue_);
}

Topics::~Topics() {
  poses_.shutdown();
  debug_images_.shutdown();
  for (ros::Publisher* publisher : {&images_, &infos_, &clock_, &transforms_}) {
    publisher->shutdown();
  }
  for (auto& [topic, publisher] : sensors_) publisher.shutdown();
  spinner_.stop();
  queue_.disable();
  node_.release(claimed_);
}

Result<std::unique_ptr<Topics>> Topics::open(Node& node,
                                             const Ros1EstimatorOptions& options,
                                             TopicHandlers handlers,
                                             std::shared_ptr<LineLog> log) {
  std::unique_ptr<Topics> topics(new Topics(node, options, std::move(handlers), std::move(log)));
  if (Status status = topics->claim_all(); !status) return status.error();
  topics->spinner_.start();
  // Subscribe first: an estimator may answer as soon as it receives an image.
  Status status = topics->subscribe_all();
  if (status) status = topics->advertise_all();
  if (!status) return status.error();
  return topics;
}

template <typename M>
Status Topics::advertise(const std::string& topic,
                         ros::Publisher& publisher,
                         bool latched,
                         int queue_size) {
  const auto reported = [this, topic](const char* what) {
    return [this, topic, what](const ros::SingleSubscriberPublisher& subscriber) {
      log_->add(subscriber.getSubscriberName() + what + topic);
    };
  };
  try {
    publisher = handle_.advertise<M>(
        topic,
        static_cast<std::uint32_t>(queue_size > 0 ? queue_size : options_.queue_size),
        reported(" subscribed to "),
        reported(" left "),
        ros::VoidConstPtr(),
        latched);
  } catch (const std::exception& failure) {
    return Error{ErrorCode::kInternal, "topic " + topic + ": " + failure.what()};
  }
  if (!publisher) {
    return Error{ErrorCode::kInternal, "topic " + topic + ": ROS rejected the publisher"};
  }
  registrations_.push_back({publisher.getTopic(), ros::message_traits::datatype<M>(), true});
  return {};
}

Status Topics::claim_all() {
  std::vector<OwnTopic> topics = own_topics(options_);
  for (OwnTopic& topic : topics) {
    if (topic.is_transform) continue;
    try {
      topic.name = handle_.resolveName(topic.name);
    } catch (const std::exception& failure) {
      return Error{ErrorCode::kInternal,
                   std::string(topic.option) + " = " + topic.name + ": " + failure.what()};
    }
  }
  if (const std::optional<OwnTopic> taken = node_.claim(topics)) {
    return Error{ErrorCode::kConflict,
                 std::string(taken->option) + " = " + taken->name +
                     ": another estimator of this process uses it; each needs its own"};
  }
  claimed_ = std::move(topics);
  return {};
}

Status Topics::advertise_all() {
  Status status = advertise<CameraInfoMessage>(options_.camera_info_topic, infos_, true);
  if (status && options_.publish_clock) {
    const OwnTopic clock{"publish_clock", kClock};
    has_clock_ = !node_.claim({clock});
    if (has_clock_) {
      claimed_.push_back(clock);
      status = advertise<ClockMessage>(kClock, clock_);
    } else {
      log_->add("another estimator of this process publishes /clock");
    }
  }
  if (status && options_.publish_tf) {
    status = advertise<TransformsMessage>(kTransforms, transforms_);
  }
  if (status && options_.publish_sensors) status = advertise_sensors();
  return status ? advertise<ImageMessage>(options_.image_topic, images_) : status;
}

Status Topics::advertise_sensors() {
  return with_each_topic([&](const std::string& topic, const auto& message) {
    const std::string name = options_.sensor_namespace + topic.substr(kSensors.size());
    return advertise<std::decay_t<decltype(message)>>(name, sensors_[topic], false, kSensorQueue);
  });
}

template <typename M, typename Handle>
Status Topics::subscribe(const std::string& topic, Handle handle, ros::Subscriber& subscriber) {
  using Pointer = typename M::ConstPtr;
  // ROS has no exception barrier: the message is dropped.
  const auto contained_handle = [log = log_, topic, handle = std::move(handle)](
                                    const Pointer& message) {
    (void)contained(
        [&] { handle(message); },
        [&](const char* what) { log->add("topic " + topic + ": a message was dropped: " + what); });
  };
  try {
    subscriber = handle_.subscribe<M>(topic,
                                      static_cast<std::uint32_t>(options_.queue_size),
                                      boost::function<void(const Pointer&)>(contained_handle),
                                      ros::VoidConstPtr(),
                                      ros::TransportHints().tcpNoDelay());
  } catch (const std::exception& failure) {
    return Error{ErrorCode::kInternal, "topic " + topic + ": " + failure.what()};
  }
  if (!subscriber) {
    return Error{ErrorCode::kInternal, "topic " + topic + ": ROS rejected the subscription"};
  }
  registrations_.push_back({subscriber.getTopic(), ros::message_traits::datatype<M>(), false});
  return {};
}

Status Topics::subscribe_pose() {
  const std::string& topic = options_.pose_topic;
  switch (options_.pose_type) {
    case Ros1PoseType::kPoseStamped:
      return subscribe<PoseStampedMessage>(
          topic,
          [this](const PoseStampedMessage::ConstPtr& message) {
            handlers_.pose(ns_of(message->header.stamp), pose_from(message->pose), {});
          },
          poses_);
    case Ros1PoseType::kPoseWithCovarianceStamped:
      return subscribe<PoseWithCovarianceStampedMessage>(
          topic,
          [this](const PoseWithCovarianceStampedMessage::ConstPtr& message) {
            handlers_.pose(ns_of(message->header.stamp),
                           pose_from(message->pose.pose),
                           message->pose.covariance);
          },
          poses_);
    case Ros1PoseType::kOdometry:
      return subscribe<OdometryMessage>(
          topic,
          [this](const OdometryMessage::ConstPtr& message) {
            handlers_.pose(ns_of(message->header.stamp),
                           pose_from(message->pose.pose),
                           message->pose.covariance);
          },
          poses_);
    case Ros1PoseType::kTf:
      break;
  }
  return subscribe<TransformsMessage>(
      kTransforms,
      [this](const TransformsMessage::ConstPtr& message) {
        for (const TransformStampedMessage& transform : message->transforms) {
          if (!same_frame(transform.header.frame_id, options_.vo_frame)) continue;
          if (!same_frame(transform.child_frame_id, options_.camera_frame)) continue;
          handlers_.pose(ns_of(transform.header.stamp), pose_from(transform.transform), {});
        }
      },
      poses_);
}

Status Topics::subscribe_all() {
  if (Status status = subscribe_pose(); !status || options_.debug_image_topic.empty()) {
    return status;
  }
  return subscribe<ImageMessage>(
      options_.debug_image_topic,
      [this](const ImageMessage::ConstPtr& message) { handlers_.debug_image(message); },
      debug_images_);
}

void Topics::publish_calibration(const VoFrame& frame, std::int64_t stamp_ns) {
  const ros::Time stamp = time_from_ns(stamp_ns);
  if (has_clock_) {
    ClockMessage now;
    now.clock = stamp;
    clock_.publish(now);
  }
  CameraInfoMessage info = message_from(frame.intrinsics, frame.distortion);
  info.header.stamp = stamp;
  info.header.frame_id = options_.camera_frame;
  infos_.publish(info);
}

void Topics::publish(const VoFrame& frame, std::int64_t stamp_ns) {
  publish_calibration(frame, stamp_ns);
  if (!sensors_.empty()) publish_samples(frame.sensors, stamp_ns - frame.t_ns);
  ImageMessage image = message_from(*frame.image);
  image.header.stamp = time_from_ns(stamp_ns);
  image.header.frame_id = options_.camera_frame;
  images_.publish(image);
}

void Topics::publish_samples(const SensorSamples& samples, std::int64_t offset_ns) {
  // It cannot fail: an ended subscriber only loses its messages.
  static_cast<void>(with_each_message(
      samples,
      [&](const char* topic, std::int64_t measured_ns, std::int64_t /*available*/, auto message) {
        message.header.stamp = time_from_ns(measured_ns + offset_ns);
        sensors_.at(topic).publish(message);
        return Status();
      }));
}

void Topics::publish_estimate(const Pose& T_vo_camera, std::int64_t stamp_ns) {
  if (!transforms_) return;
  TransformsMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.stamp = time_from_ns(stamp_ns);
  message.transforms[0].header.frame_id = options_.vo_frame;
  message.transforms[0].child_frame_id = options_.camera_frame;
  message.transforms[0].transform = transform_message_from(T_vo_camera);
  transforms_.publish(message);
}

std::vector<TopicRegistration> Topics::registrations() const { return registrations_; }

}  // namespace overfly::ros1
