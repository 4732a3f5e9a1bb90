// A ROS node that answers each image with a pose that proves what it received: x is the CRC-32 of
// the image's bytes, y the focal length of the calibration; rotated by the first byte's value in
// hundredths of a radian about x.
//   ros1_test_node image=TOPIC info=TOPIC pose=TOPIC type=TYPE [debug=TOPIC]
//     [parent=FRAME child=FRAME] [invert=1] [body_axes=1] [delay_ms=N] [silent_until=N] [every=N]
//     [wait_for_info=1] [stamp_off_s=N] [bad_pose=1]
//     [covariance=1 (stated) or 2 (not symmetric)] [debug_encoding=NAME] [debug_scale=N]
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/topic.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <thread>

#include "core/camera/image.hpp"
#include "core/measure/crc32.hpp"
#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/types.hpp"
#include "vo_bridges/vo_port.hpp"

namespace {

using namespace overfly;
using namespace overfly::ros1;

std::map<std::string, std::string> settings;

std::string text(const std::string& key) { return settings[key]; }
int number(const std::string& key) { return std::atoi(settings[key].c_str()); }

Pose answer_to(const ImageMessage& image, double fx_px) {
  Image bytes(static_cast<int>(image.width), static_cast<int>(image.height), 1);
  bytes.data.assign(image.data.begin(), image.data.end());
  Pose pose;
  pose.translation = {static_cast<double>(crc32_of(bytes)), fx_px, 3.0};
  pose.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * image.data[0], Eigen::Vector3d::UnitX()));
  if (number("body_axes") != 0) {
    Eigen::Matrix3d R_optical_body;  // ahead, left, up in right, down, ahead
    R_optical_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    pose.rotation = pose.rotation * Eigen::Quaterniond(R_optical_body);
  }
  if (number("invert") != 0) pose = pose.inverse();
  if (number("bad_pose") != 0) pose.translation.x() = std::numeric_limits<double>::quiet_NaN();
  return pose;
}

class Estimator {
 public:
  Estimator() {
    if (number("wait_for_info") != 0) {
      const auto info = ros::topic::waitForMessage<CameraInfoMessage>(text("info"));
      if (info) fx_px_ = info->K[0];
      std::this_thread::sleep_for(std::chrono::milliseconds(300));  // loads
    }
    const std::string type = text("type");
    const std::string topic = text("pose");
    // Poses and debug images first: who sees that we listen must hear us.
    if (type == "pose_stamped") poses_ = node_.advertise<PoseStampedMessage>(topic, 10);
    if (type == "odometry") poses_ = node_.advertise<OdometryMessage>(topic, 10);
    if (type == "pose_with_covariance_stamped") {
      poses_ = node_.advertise<PoseWithCovarianceStampedMessage>(topic, 10);
    }
    if (type == "tf") poses_ = node_.advertise<TransformsMessage>("/tf", 10);
    if (!text("debug").empty()) debugs_ = node_.advertise<ImageMessage>(text("debug"), 10);
    using std::placeholders::_1;
    infos_ = subscribe<CameraInfoMessage>(text("info"), [this](const auto& m) { on_info(*m); });
    clocks_ = subscribe<ClockMessage>(
        "/clock", [](const auto& m) { std::printf("clock %.9f\n", m->clock.toSec()); });
    transforms_ = subscribe<TransformsMessage>("/tf", [](const auto& m) { on_tf(*m); });
    imu_ = subscribe<ImuMessage>("/sensors/imu", [](const auto& m) {
      std::printf("imu %.3f wz %g az %g %s\n",
                  m->header.stamp.toSec(),
                  m->angular_velocity.z,
                  m->linear_acceleration.z,
                  m->header.frame_id.c_str());
    });
    fixes_ = subscribe<NavSatFixMessage>("/sensors/gps/fix", [](const auto& m) {
      std::printf("fix %.3f status %d lat %g\n",
                  m->header.stamp.toSec(),
                  static_cast<int>(m->status.status),
                  m->latitude);
    });
    images_ = subscribe<ImageMessage>(text("image"), [this](const auto& m) { on_image(*m); });
  }

 private:
  template <typename M, typename Handle>
  ros::Subscriber subscribe(const std::string& topic, Handle handle) {
    return node_.subscribe<M>(topic,
                              100,
                              boost::function<void(const typename M::ConstPtr&)>(handle),
                              ros::VoidConstPtr(),
                              ros::TransportHints().tcpNoDelay());
  }

  void on_info(const CameraInfoMessage& info) {
    fx_px_ = info.K[0];
    std::printf("camera_info %u x %u %s D", info.width, info.height, info.distortion_model.c_str());
    for (const double k : info.D) std::printf(" %g", k);
    std::printf(" K %g %g %g %g\n", info.K[0], info.K[4], info.K[2], info.K[5]);
  }

  static void on_tf(const TransformsMessage& message) {
    const TransformStampedMessage& t = message.transforms.at(0);
    std::printf("tf %s -> %s x %.0f\n",
                t.header.frame_id.c_str(),
                t.child_frame_id.c_str(),
                t.transform.translation.x);
  }

  void on_image(const ImageMessage& image) {
    std::printf("image %s %s\n", image.encoding.c_str(), image.header.frame_id.c_str());
    std::this_thread::sleep_for(std::chrono::milliseconds(number("delay_ms")));
    ++seen_;
    if (seen_ <= number("silent_until")) return;
    if (number("every") > 1 && seen_ % number("every") != 0) return;
    // Calibration comes on a connection of its own, which may be a little slower the first time.
    for (int i = 0; i < 200 && fx_px_ == 0.0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ros::getGlobalCallbackQueue()->callOne();
    }
    if (debugs_) publish_debug(image);
    publish(answer_to(image, fx_px_), image.header.stamp + ros::Duration(number("stamp_off_s")));
  }

  void publish_debug(const ImageMessage& image) {
    ImageMessage debug = image;
    if (const int scale = number("debug_scale"); scale > 1) {
      debug.width = image.width * static_cast<unsigned>(scale);
      debug.height = image.height * static_cast<unsigned>(scale);
      debug.step = debug.width;
      debug.data.assign(std::size_t{debug.step} * debug.height, 77);
    }
    if (!text("debug_encoding").empty()) debug.encoding = text("debug_encoding");
    debugs_.publish(debug);
  }

  void publish(const Pose& pose, ros::Time stamp) {
    const std::string type = text("type");
    if (type == "pose_stamped") publish_pose<PoseStampedMessage>(pose, stamp);
    if (type == "odometry") publish_inner_pose<OdometryMessage>(pose, stamp);
    if (type == "pose_with_covariance_stamped") {
      publish_inner_pose<PoseWithCovarianceStampedMessage>(pose, stamp);
    }
    if (type == "tf") {
      TransformsMessage message;
      message.transforms.resize(2);
      message.transforms[0].header.frame_id = "odom";  // somebody else's
      message.transforms[0].child_frame_id = text("child");
      message.transforms[0].header.stamp = message.transforms[1].header.stamp = stamp;
      message.transforms[0].transform = transform_message_from(Pose());
      message.transforms[1].header.frame_id = "/" + text("parent");
      message.transforms[1].child_frame_id = text("child");
      message.transforms[1].transform = transform_message_from(pose);
      poses_.publish(message);
    }
  }

  template <typename M>
  void publish_pose(const Pose& pose, ros::Time stamp) {
    M message;
    message.header.stamp = stamp;
    message.pose = pose_message_from(pose);
    poses_.publish(message);
  }

  template <typename M>
  void publish_inner_pose(const Pose& pose, ros::Time stamp) {
    M message;
    message.header.stamp = stamp;
    message.pose.pose = pose_message_from(pose);
    if (number("covariance") != 0) {
      for (std::size_t i = 0; i < 6; ++i) {
        message.pose.covariance[7 * i] = 0.25 * static_cast<double>(i + 1);
      }
      message.pose.covariance[1] = message.pose.covariance[6] = 0.125;
    }
    if (number("covariance") == 2) message.pose.covariance[3] = 0.5;
    poses_.publish(message);
  }

  ros::NodeHandle node_;
  ros::Publisher poses_, debugs_;
  ros::Subscriber imu_, fixes_, images_, infos_, clocks_, transforms_;
  double fx_px_ = 0.0;
  int seen_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  ros::init(argc, argv, "test_node", ros::init_options::NoRosout);
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals != std::string::npos) {
      settings[argument.substr(0, equals)] = argument.substr(equals + 1);
    }
  }
  const Estimator estimator;
  ros::spin();
}
