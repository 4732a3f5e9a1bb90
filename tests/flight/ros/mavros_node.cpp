// A ROS node that publishes the topics of MAVROS under a prefix, as soon as somebody listens.
//   mavros_node PREFIX TLOG FROM_MS TO_MS   messages of a recording
//   mavros_node PREFIX disarm               two seconds of poses, then "disarmed"
//   mavros_node PREFIX restart              stamps that go back
//   mavros_node PREFIX restart_early        and before there is a position
//   mavros_node PREFIX odd                  messages of another type, cut ones, and far too large
//   ones
// It prints a line when all is sent, and stays.
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "tests/flight/ros/mavros_messages.hpp"

namespace {

using namespace overfly;
using namespace overfly::flight;

/// Bytes sent as a message of a given type.
struct AnyMessage {
  std::vector<std::uint8_t> bytes;
};

}  // namespace

namespace ros {
namespace message_traits {
template <>
struct IsMessage<AnyMessage> : TrueType {};
template <>
struct MD5Sum<AnyMessage> {
  static const char* value() { return "*"; }
  static const char* value(const AnyMessage& /*message*/) { return "*"; }
};
template <>
struct DataType<AnyMessage> {
  static const char* value() { return "*"; }
  static const char* value(const AnyMessage& /*message*/) { return "*"; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<AnyMessage> {
  template <typename Stream>
  static void write(Stream& stream, const AnyMessage& message) {
    const auto size = static_cast<std::uint32_t>(message.bytes.size());
    if (size > 0) std::memcpy(stream.advance(size), message.bytes.data(), size);
  }
  static std::uint32_t serializedLength(const AnyMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace {

void wait_for_subscribers(const ros::Publisher& publisher) {
  for (int i = 0; i < 4000 && publisher.getNumSubscribers() == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// A topic that goes with its publisher takes along what was not sent yet.
std::vector<ros::Publisher> kept_publishers;

template <typename Message>
ros::Publisher publisher_of(ros::NodeHandle& handle, const std::string& topic) {
  kept_publishers.push_back(handle.advertise<Message>(topic, 0));  // 0: keeps all that waits
  return kept_publishers.back();
}

ros::Publisher publisher_of(ros::NodeHandle& handle,
                            const std::string& topic,
                            const std::string& type) {
  ros::AdvertiseOptions options(
      topic, 0, "0123456789abcdef0123456789abcdef", type, "");  // 0: keeps all
  kept_publishers.push_back(handle.advertise(options));
  wait_for_subscribers(kept_publishers.back());
  return kept_publishers.back();
}

/// mavros_msgs/State: header, connected, armed, guided, manual_input, mode, system_status.
/// @param t_ms  of the vehicle's clock; negative: the stamp is not set
AnyMessage state_message(bool armed, std::int64_t t_ms = -1, const std::string& mode = "") {
  AnyMessage message;
  message.bytes.assign(12, 0);  // seq, stamp
  if (t_ms >= 0) {
    const ros::Time stamp = testing::stamp_of(t_ms * 1'000'000);
    std::memcpy(&message.bytes[4], &stamp.sec, 4);
    std::memcpy(&message.bytes[8], &stamp.nsec, 4);
  }
  message.bytes.resize(16, 0);  // an empty frame_id
  message.bytes.push_back(1);   // connected
  message.bytes.push_back(armed ? 1 : 0);
  message.bytes.resize(message.bytes.size() + 2, 0);  // guided, manual_input
  message.bytes.push_back(static_cast<std::uint8_t>(mode.size()));
  message.bytes.resize(message.bytes.size() + 3, 0);
  message.bytes.insert(message.bytes.end(), mode.begin(), mode.end());
  message.bytes.push_back(0);  // system_status
  return message;
}

void fly(ros::NodeHandle& handle, const std::string& prefix, char** argv) {
  ros::Publisher global = publisher_of<testing::FixMessage>(handle, prefix + "/global");
  ros::Publisher imu = publisher_of<testing::ImuMessage>(handle, prefix + "/imu");
  ros::Publisher pose = publisher_of<ros1::PoseStampedMessage>(handle, prefix + "/pose");
  ros::Publisher raw_imu = publisher_of<testing::ImuMessage>(handle, prefix + "/imu_raw");
  ros::Publisher field = publisher_of<testing::FieldMessage>(handle, prefix + "/mag");
  ros::Publisher pressure = publisher_of<testing::PressureMessage>(handle, prefix + "/pressure");
  ros::Publisher state = publisher_of(handle, prefix + "/state", "mavros_msgs/State");
  for (const ros::Publisher& sensor : {raw_imu, field, pressure}) wait_for_subscribers(sensor);
  // The flight listens to two of the three.
  for (int i = 0; i < 4000; ++i) {
    const int listened = (global.getNumSubscribers() > 0 ? 1 : 0) +
                         (imu.getNumSubscribers() > 0 ? 1 : 0) +
                         (pose.getNumSubscribers() > 0 ? 1 : 0);
    if (listened >= 2) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  state.publish(state_message(true));
  testing::MavrosTopics topics;
  topics.global = [&](const testing::FixMessage& message) { global.publish(message); };
  topics.imu = [&](const testing::ImuMessage& message) { imu.publish(message); };
  topics.pose = [&](const ros1::PoseStampedMessage& message) { pose.publish(message); };
  topics.raw_imu = [&](const testing::ImuMessage& message) { raw_imu.publish(message); };
  topics.field = [&](const testing::FieldMessage& message) { field.publish(message); };
  topics.pressure = [&](const testing::PressureMessage& message) { pressure.publish(message); };
  testing::publish_recording(argv[2], std::atoll(argv[3]), std::atoll(argv[4]), topics);
}

ros1::PoseStampedMessage pose_at(std::int64_t t_ms) {
  ros1::PoseStampedMessage pose;
  pose.header.stamp = testing::stamp_of(t_ms * 1'000'000);
  pose.pose.position.x = 0.025 * static_cast<double>(t_ms);
  pose.pose.orientation.w = 1.0;
  return pose;
}

void restart(ros::NodeHandle& handle, const std::string& prefix) {
  ros::Publisher pose = publisher_of<ros1::PoseStampedMessage>(handle, prefix + "/pose");
  wait_for_subscribers(pose);
  for (std::int64_t t_ms = 60'000; t_ms <= 62'000; t_ms += 20) pose.publish(pose_at(t_ms));
  for (std::int64_t t_ms = 0; t_ms <= 1000; t_ms += 20) pose.publish(pose_at(t_ms));
}

/// Stamps of poses that go back before there are positions.
void restart_early(ros::NodeHandle& handle, const std::string& prefix) {
  ros::Publisher pose = publisher_of<ros1::PoseStampedMessage>(handle, prefix + "/pose");
  ros::Publisher global = publisher_of<testing::FixMessage>(handle, prefix + "/global");
  wait_for_subscribers(pose);
  wait_for_subscribers(global);
  for (std::int64_t t_ms = 60'000; t_ms <= 61'000; t_ms += 20) pose.publish(pose_at(t_ms));
  // The topics have connections of their own: both repeat what may have come too early.
  for (std::int64_t t_ms = 0; t_ms <= 20'000; t_ms += 20) {
    pose.publish(pose_at(t_ms));
    testing::FixMessage fix;
    fix.header.stamp = testing::stamp_of(t_ms * 1'000'000);
    fix.latitude = 47.0;
    fix.longitude = 8.0;
    global.publish(fix);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void disarm(ros::NodeHandle& handle, const std::string& prefix) {
  ros::Publisher pose = publisher_of<ros1::PoseStampedMessage>(handle, prefix + "/pose");
  ros::Publisher state = publisher_of(handle, prefix + "/state", "mavros_msgs/State");
  wait_for_subscribers(pose);
  state.publish(state_message(true, 0, "AUTO"));
  state.publish(state_message(true, 1000, "AUTO"));
  state.publish(state_message(true, 1500, "RTL"));
  for (std::int64_t t_ms = 0; t_ms <= 2000; t_ms += 20) pose.publish(pose_at(t_ms));
  // Connections of their own: the first of these may overtake the poses.
  for (int i = 0; i < 100; ++i) {
    state.publish(state_message(false, 2000, "RTL"));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void send_odd(ros::NodeHandle& handle, const std::string& prefix) {
  // Too large, cut in its numbers, and with a text that is longer than the message.
  ros::Publisher pose = publisher_of(handle, prefix + "/pose", "geometry_msgs/PoseStamped");
  pose.publish(AnyMessage{std::vector<std::uint8_t>(1U << 20U, 1)});
  pose.publish(AnyMessage{std::vector<std::uint8_t>(30, 0)});
  pose.publish(AnyMessage{});
  pose.publish(AnyMessage{std::vector<std::uint8_t>(72, 0xFF)});
  ros::Publisher imu = publisher_of(handle, prefix + "/imu", "sensor_msgs/Temperature");
  for (int i = 0; i < 100; ++i) imu.publish(AnyMessage{std::vector<std::uint8_t>(28, 0)});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  ros::init(argc,
            argv,
            "mavros",
            ros::init_options::NoSigintHandler | ros::init_options::NoRosout |
                ros::init_options::AnonymousName);
  ros::NodeHandle handle;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const std::string prefix = argv[1];
  const std::string what = argv[2];
  if (what == "restart") {
    restart(handle, prefix);
  } else if (what == "restart_early") {
    restart_early(handle, prefix);
  } else if (what == "disarm") {
    disarm(handle, prefix);
  } else if (what == "odd") {
    send_odd(handle, prefix);
  } else if (argc >= 5) {
    fly(handle, prefix, argv);
  }
  std::puts("all is sent");
  std::fflush(stdout);
  ros::waitForShutdown();
  return 0;
}
