#include "middleware/ros1/flight_publisher.hpp"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <utility>
#include <vector>

#include "middleware/ros1/line_log.hpp"
#include "middleware/ros1/master_watch.hpp"
#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/node.hpp"
#include "middleware/ros1/sensor_messages.hpp"

namespace overfly::ros1 {

/// mavros_msgs/State; the package is not needed for it.
struct MavrosStateMessage {
  ros::Time stamp;
  bool armed = false;
  const char* mode = "";
};

}  // namespace overfly::ros1

// NOLINTBEGIN(readability-identifier-naming): names required by ROS
namespace ros {
namespace message_traits {

template <>
struct IsMessage<overfly::ros1::MavrosStateMessage> : TrueType {};

/// Of the definition in mavros_msgs 1.x, whose constants (names of modes) are part of the checksum.
template <>
struct MD5Sum<overfly::ros1::MavrosStateMessage> {
  static const char* value() { return "65cd0a9fff993b062b91e354554ec7e9"; }
  static const char* value(const overfly::ros1::MavrosStateMessage& /*message*/) { return value(); }
};
template <>
struct DataType<overfly::ros1::MavrosStateMessage> {
  static const char* value() { return "mavros_msgs/State"; }
  static const char* value(const overfly::ros1::MavrosStateMessage& /*message*/) { return value(); }
};
template <>
struct Definition<overfly::ros1::MavrosStateMessage> {
  static const char* value() {
    return "std_msgs/Header header\nbool connected\nbool armed\nbool guided\nbool manual_input\n"
           "string mode\nuint8 system_status\n"
           // Recorders keep this text, and decode by it what they have no package for.
           "================================================================================\n"
           "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
  }
  static const char* value(const overfly::ros1::MavrosStateMessage& /*message*/) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<overfly::ros1::MavrosStateMessage> {
  /// header, connected, armed, guided, manual_input, mode, system_status (MAV_STATE of MAVLink:
  /// 4 active, 3 standby).
  template <typename Stream>
  static void write(Stream& stream, const overfly::ros1::MavrosStateMessage& message) {
    stream.next(std::uint32_t{0});  // seq: unlike with generated types, nobody fills it in
    stream.next(message.stamp);
    stream.next(std::string());
    stream.next(std::uint8_t{1});
    stream.next(static_cast<std::uint8_t>(message.armed ? 1 : 0));
    stream.next(std::uint8_t{0});
    stream.next(std::uint8_t{0});
    stream.next(std::string(message.mode));
    stream.next(static_cast<std::uint8_t>(message.armed ? 4 : 3));
  }
  static std::uint32_t serializedLength(const overfly::ros1::MavrosStateMessage& message) {
    constexpr std::uint32_t kFixedBytes = 4 + 8 + 4 + 4 + 4 + 1;
    return kFixedBytes + static_cast<std::uint32_t>(std::string(message.mode).size());
  }
};

}  // namespace serialization
}  // namespace ros
// NOLINTEND(readability-identifier-naming)

namespace overfly::ros1 {
namespace {

constexpr const char* kMapFrame = "map";
constexpr const char* kMavrosBodyFrame = "base_link";

template <typename Orientation>
void set_orientation(Orientation& to, const Eigen::Quaterniond& R_enu_body) {
  // Forward-left-up of forward-right-down: half a turn about the first axis.
  const Eigen::Quaterniond R = R_enu_body * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
  to.w = R.w();
  to.x = R.x();
  to.y = R.y();
  to.z = R.z();
}

class RosFlightPublisher final : public FlightPublisher {
 public:
  RosFlightPublisher() : spinner_(1, &queue_) { handle_.setCallbackQueue(&queue_); }
  ~RosFlightPublisher() override {
    watch_.reset();
    for (ros::Publisher* publisher : {&pose_, &global_, &imu_, &state_}) publisher->shutdown();
    spinner_.stop();
    queue_.disable();
  }

  Status advertise(const Node& node) {
    try {
      pose_ = handle_.advertise<PoseStampedMessage>("/mavros/local_position/pose", kMostWaiting);
      global_ = handle_.advertise<NavSatFixMessage>("/mavros/global_position/global", kMostWaiting);
      imu_ = handle_.advertise<ImuMessage>("/mavros/imu/data", kMostWaiting);
      // Latched: whoever comes later knows the vehicle's state at once.
      state_ = handle_.advertise<MavrosStateMessage>("/mavros/state", kMostWaiting, true);
    } catch (const std::exception& failure) {
      return Error{ErrorCode::kInternal, std::string("ROS cannot publish: ") + failure.what()};
    }
    spinner_.start();
    std::vector<TopicRegistration> registrations = {{pose_.getTopic(), "geometry_msgs/PoseStamped"},
                                                    {global_.getTopic(), "sensor_msgs/NavSatFix"},
                                                    {imu_.getTopic(), "sensor_msgs/Imu"},
                                                    {state_.getTopic(), "mavros_msgs/State"}};
    const auto nothing = [](const std::atomic<bool>& /*cancel*/) {};
    watch_ = std::make_unique<MasterWatch>(
        node.master(), node.name(), std::move(registrations), log_, nothing);
    return {};
  }

  void publish(const PublishedInstant& instant) override {
    const ros::Time stamp = time_from_ns(instant.stamp_ns);
    // The attitude first: a listener that joins both has one at the position's time.
    ImuMessage imu = message_from(instant.imu);
    imu.header.stamp = stamp;
    imu.header.frame_id = kMavrosBodyFrame;
    set_orientation(imu.orientation, instant.R_enu_body);
    imu.orientation_covariance[0] = 0.0;  // there is an orientation, of unknown covariance
    imu_.publish(imu);
    NavSatFixMessage fix = message_from(instant.gps);
    fix.header.stamp = stamp;
    fix.header.frame_id = kMavrosBodyFrame;
    global_.publish(fix);
    PoseStampedMessage pose;
    pose.header.stamp = stamp;
    pose.header.frame_id = kMapFrame;
    pose.pose.position.x = instant.position_map_m.x();
    pose.pose.position.y = instant.position_map_m.y();
    pose.pose.position.z = instant.position_map_m.z();
    set_orientation(pose.pose.orientation, instant.R_enu_body);
    pose_.publish(pose);
  }
  void publish_state(std::int64_t stamp_ns, bool armed) override {
    state_.publish(MavrosStateMessage{time_from_ns(stamp_ns), armed, "AUTO"});
  }
  [[nodiscard]] bool is_heard() const override {
    return pose_.getNumSubscribers() > 0 || global_.getNumSubscribers() > 0 ||
           imu_.getNumSubscribers() > 0;
  }

 private:
  std::shared_ptr<LineLog> log_ = std::make_shared<LineLog>();
  ros::CallbackQueue queue_;
  ros::NodeHandle handle_;
  ros::AsyncSpinner spinner_;
  ros::Publisher pose_;
  ros::Publisher global_;
  ros::Publisher imu_;
  ros::Publisher state_;
  std::unique_ptr<MasterWatch> watch_;
};

}  // namespace

Result<std::unique_ptr<FlightPublisher>> FlightPublisher::open(
    const FlightPublisherOptions& options, const std::atomic<bool>* cancel) {
  const auto master = parse_xml_rpc_address(options.master_uri);
  if (!master) return master.error();
  const Result<Node*> node = Node::join(*master, options.node_name, options.patience, cancel);
  if (!node) return node.error();
  auto publisher = std::make_unique<RosFlightPublisher>();
  if (Status status = publisher->advertise(**node); !status) return status.error();
  return std::unique_ptr<FlightPublisher>(std::move(publisher));
}

}  // namespace overfly::ros1
