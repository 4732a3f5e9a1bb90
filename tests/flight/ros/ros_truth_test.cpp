// Flights from ROS topics against the raw MAVLink messages of the same flight.
#include "flight/ros/ros_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "core/sensors/sample_source.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/replay/logged_flight.hpp"
#include "tests/flight/ros/mavros_messages.hpp"
#include "tests/support/support.hpp"
#include "tests/vo_bridges/ros1/ros_world.hpp"

namespace overfly::flight::ros_live {
namespace {

using overfly::testing::Child;
using overfly::testing::larger_error;
using overfly::testing::RosMaster;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

/// The climb and the first turns.
constexpr std::int64_t kFromMs = 50'000;
constexpr std::int64_t kToMs = 110'000;
constexpr double kPlaceLat = -35.363262;
constexpr double kPlaceLon = 149.165237;

LocalFrame place_frame() { return LocalFrame(geodetic_from_deg(kPlaceLat, kPlaceLon, 600.0)); }

/// A vehicle's node with topics of its own.
class MavrosNode {
 public:
  explicit MavrosNode(const std::vector<std::string>& arguments) {
    static int count = 0;
    prefix_ = "/vehicle" + std::to_string(count++);
    std::vector<std::string> command = {MAVROS_NODE, prefix_};
    command.insert(command.end(), arguments.begin(), arguments.end());
    command.push_back("__master:=" + RosMaster::instance().uri());
    child_ = std::make_unique<Child>(command, folder_.path() / "out.txt");
  }
  [[nodiscard]] RosFlight flight() const {
    RosFlight flight;
    flight.master_uri = RosMaster::instance().uri();
    flight.node_name = "overfly_flight_test";
    flight.pose_topic = prefix_ + "/pose";
    flight.global_topic = prefix_ + "/global";
    flight.imu_topic = prefix_ + "/imu";
    flight.state_topic = prefix_ + "/state";
    flight.sensor_topics = {prefix_ + "/imu_raw", prefix_ + "/mag", prefix_ + "/pressure"};
    return flight;
  }

 private:
  TemporaryFolder folder_;
  std::string prefix_;
  std::unique_ptr<Child> child_;
};

/// The poses of the raw MAVLink messages at the times of their positions, with the latest
/// attitudes.
std::vector<logs::LogPose> mavlink_poses(const std::filesystem::path& file,
                                         const std::string& source) {
  const auto log = logs::open_log(file);
  EXPECT_TRUE(log.ok());
  logs::TrajectoryRequest request;
  request.source = source;
  request.from_ns = (kFromMs + 200) * 1'000'000;
  request.to_ns = (kToMs - 200) * 1'000'000;
  auto trajectory = logs::read_log_trajectory(*log, request);
  EXPECT_TRUE(trajectory.ok()) << trajectory.error().message;
  return std::move(trajectory->poses);
}

/// Whether a flight shows a change of sign or a swap of any two axes: it goes in all directions and
/// turns about all axes.
void expect_all_axes(const std::vector<logs::LogPose>& poses) {
  Eigen::Vector3d most = Eigen::Vector3d::Zero();
  for (const logs::LogPose& pose : poses) {
    const RollPitchYaw angles = attitude_from(logs::R_enu_ned() * pose.R_ned_body);
    most = most.cwiseMax(
        Eigen::Vector3d(angles.roll_rad, angles.pitch_rad, angles.yaw_rad).cwiseAbs());
  }
  EXPECT_GT(most.x(), rad_from_deg(20.0));
  EXPECT_GT(most.y(), rad_from_deg(5.0));
  EXPECT_GT(most.z(), rad_from_deg(45.0));
}

/// The vehicle's clock at the flight's start: both topics are known from there on.
std::int64_t start_of(const std::filesystem::path& file, bool local) {
  std::optional<std::int64_t> position_ns;
  std::optional<std::int64_t> attitude_ns;
  const auto ns = [](const auto& message) {
    return static_cast<std::int64_t>(message.header.stamp.toNSec()) - testing::kBootUnixNs;
  };
  testing::MavrosTopics topics;
  topics.global = [&](const auto& message) {
    if (!local && !position_ns) position_ns = ns(message);
  };
  topics.pose = [&](const auto& message) {
    if (local && !position_ns) position_ns = ns(message);
  };
  topics.imu = [&](const auto& message) {
    if (!attitude_ns) attitude_ns = ns(message);
  };
  testing::publish_recording(file, kFromMs, kFromMs + 1000, topics);
  return std::max(*position_ns, *attitude_ns);
}

TEST(RosTruth, FliesTheGlobalTopicAsTheRawMessages) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.tlog");
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({file.string(), std::to_string(kFromMs), std::to_string(kToMs)});
  const LocalFrame frame = place_frame();
  const auto truth = fly_ros(node.flight(), frame, nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const std::int64_t start_ns = start_of(file, false);
  const std::vector<logs::LogPose> poses = mavlink_poses(file, "GLOBAL_POSITION_INT");
  ASSERT_GT(poses.size(), 2900U);
  expect_all_axes(poses);
  double worst_m = 0.0;
  double worst_rad = 0.0;
  for (const logs::LogPose& pose : poses) {
    const auto state = (*truth)->state_at(pose.t_ns - start_ns);
    ASSERT_TRUE(state.ok() && *state) << state.error().message;
    const Geodetic point = geodetic_from_deg(
        pose.position.x(), pose.position.y(), pose.position.z() + testing::kSitlGeoidM);
    worst_m = larger_error(
        worst_m, ((*state)->T_world_body.translation - frame.world_from_geodetic(point)).norm());
    const Eigen::Quaterniond R_world_body =
        frame.R_world_enu_at(point) * logs::R_enu_ned() * pose.R_ned_body;
    worst_rad =
        larger_error(worst_rad, rotation_angle_rad((*state)->T_world_body.rotation, R_world_body));
  }
  EXPECT_LT(worst_m, 1e-6);
  EXPECT_LT(deg_from_rad(worst_rad), 1e-4);
  EXPECT_TRUE((*truth)->heard_ns());
  EXPECT_THAT((*truth)->description(), HasSubstr("/global, "));
  EXPECT_THAT((*truth)->warnings(), ::testing::IsEmpty());
}

TEST(RosTruth, FliesThePoseTopicAsTheRawMessages) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.tlog");
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({file.string(), std::to_string(kFromMs), std::to_string(kToMs)});
  RosFlight flight = node.flight();
  flight.local = true;
  // With the world's origin as that of the topic, east, north, up are the world's.
  const auto truth = fly_ros(flight, place_frame(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const std::int64_t start_ns = start_of(file, true);
  std::size_t compared = 0;
  double worst_m = 0.0;
  testing::for_each_frame(file, [&](const mavlink::Frame& frame, std::span<const std::uint8_t>) {
    if (frame.message_id != 32) return true;
    const std::int64_t t_ns = *mavlink::boot_time_ns(frame);
    if (t_ns < start_ns) return true;
    if (t_ns > (kToMs - 200) * 1'000'000) return false;
    const auto state = (*truth)->state_at(t_ns - start_ns);
    if (!state || !*state) return false;
    const Eigen::Vector3d ned = mavlink::decode_local_position(frame).position_ned_m;
    const Eigen::Vector3d enu(ned.y(), ned.x(), -ned.z());
    worst_m = larger_error(worst_m, ((*state)->T_world_body.translation - enu).norm());
    ++compared;
    return true;
  });
  EXPECT_GT(compared, 5900U);
  EXPECT_LT(worst_m, 1e-6);
}

TEST(RosTruth, HasTheSensorsOfTheRawMessages) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.tlog");
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({file.string(), std::to_string(kFromMs), std::to_string(kToMs)});
  const auto truth = fly_ros(node.flight(), place_frame(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const std::int64_t start_ns = start_of(file, false);
  constexpr std::int64_t kLastNs = 55 * kNsPerS;
  ASSERT_TRUE((*truth)->state_at(kLastNs).ok());
  // Each topic has a connection of its own: any of them may be the last.
  SampleSource* const source = (*truth)->sample_source();
  ASSERT_NE(source, nullptr);
  SensorSamples published;
  for (int i = 0; i < 500; ++i) {
    append(published, source->take_samples(kLastNs));
    if (published.imu.size() > 2700 && published.magnetometer.size() > 2700 &&
        published.barometer.size() > 50 && published.gps.size() > 2000) {
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  // The same messages read as a recording of the vehicle.
  auto recording = fly_flight_log(file, {}, place_frame(), FlatGround(0.0), SourcePolicy());
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  const std::int64_t shift_ns = start_ns - (*recording)->log_start_ns().value();
  const SensorSamples recorded = (*recording)->sample_source()->take_samples(1000 * kNsPerS);
  const auto compare = [&](const auto& list, const auto& others, const auto& difference) {
    std::size_t compared = 0;
    double worst = 0.0;
    auto other = others.begin();
    for (const auto& sample : list) {
      while (other != others.end() && other->t_ns < sample.t_ns + shift_ns) ++other;
      if (other == others.end() || other->t_ns != sample.t_ns + shift_ns) continue;
      ++compared;
      worst = larger_error(worst, difference(sample, *other));
    }
    EXPECT_EQ(compared, list.size());
    return std::pair(compared, worst);
  };
  const auto imu = compare(published.imu, recorded.imu, [](const auto& a, const auto& b) {
    return (a.angular_rate_rad_s - b.angular_rate_rad_s).norm() +
           (a.acceleration_m_s2 - b.acceleration_m_s2).norm();
  });
  EXPECT_GT(imu.first, 2000U);
  EXPECT_LT(imu.second, 1e-9);
  const auto field =
      compare(published.magnetometer, recorded.magnetometer, [](const auto& a, const auto& b) {
        return (a.field_ut - b.field_ut).norm();
      });
  EXPECT_GT(field.first, 2000U);
  EXPECT_LT(field.second, 1e-9);
  const auto pressure =
      compare(published.barometer, recorded.barometer, [](const auto& a, const auto& b) {
        return std::abs(a.pressure_pa - b.pressure_pa);
      });
  EXPECT_GT(pressure.first, 50U);
  EXPECT_LT(pressure.second, 1e-9);
  // Of the global topic.
  ASSERT_GT(published.gps.size(), 2000U);
  EXPECT_EQ(published.gps[0].fix, GpsFixType::k3d);
  EXPECT_THAT(source->sensor_report(), HasSubstr("sensors of the vehicle: imu from "));
  EXPECT_THAT(source->sensor_report(), HasSubstr("/imu_raw ("));
  EXPECT_THAT(source->sensor_report(), HasSubstr("not published: airspeed, range"));
}

TEST(RosTruth, ABagOfTheSameTopicsIsTheSameFlight) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.tlog");
  const TemporaryFolder folder;
  const auto bag_file = folder.path() / "a.bag";
  {
    rosbag::Bag bag(bag_file.string(), rosbag::bagmode::Write);
    testing::MavrosTopics topics;
    topics.global = [&](const testing::FixMessage& m) {
      bag.write("/mavros/global_position/global", m.header.stamp, m);
    };
    topics.imu = [&](const testing::ImuMessage& m) {
      bag.write("/mavros/imu/data", m.header.stamp, m);
    };
    topics.pose = [&](const ros1::PoseStampedMessage& m) {
      bag.write("/mavros/local_position/pose", m.header.stamp, m);
    };
    testing::publish_recording(file, kFromMs, kToMs, topics);
  }
  const auto log = logs::open_log(bag_file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto trajectory =
      logs::read_log_trajectory(*log, {"/mavros/global_position/global", {}, {}});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  std::map<std::int64_t, logs::LogPose> by_time;
  for (const logs::LogPose& pose : trajectory->poses) {
    by_time[pose.t_ns - testing::kBootUnixNs] = pose;
  }
  const std::vector<logs::LogPose> poses = mavlink_poses(file, "GLOBAL_POSITION_INT");
  ASSERT_GT(poses.size(), 2900U);
  for (const logs::LogPose& pose : poses) {
    ASSERT_TRUE(by_time.contains(pose.t_ns)) << pose.t_ns;
    const logs::LogPose& other = by_time[pose.t_ns];
    EXPECT_NEAR(other.position.x(), pose.position.x(), 1e-12);
    EXPECT_NEAR(other.position.y(), pose.position.y(), 1e-12);
    EXPECT_NEAR(other.position.z(), pose.position.z() + testing::kSitlGeoidM, 1e-9);
    // Of the two attitudes in the bag it is that of the pose topic, which is up to 10 ms old: the
    // aircraft turns by less than 2 deg in that time.
    EXPECT_LT(deg_from_rad(rotation_angle_rad(other.R_ned_body, pose.R_ned_body)), 2.0);
  }
}

TEST(RosTruth, EndsWhenStampsGoBack) {
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({"restart"});
  RosFlight flight = node.flight();
  flight.local = true;
  flight.attitude_of_pose = true;
  const auto truth = fly_ros(flight, place_frame(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto middle = (*truth)->state_at(kNsPerS);
  ASSERT_TRUE(middle.ok() && *middle);
  EXPECT_NEAR((*middle)->T_world_body.translation.x(), 0.025 * 61'000, 1e-6);
  EXPECT_NEAR((*middle)->v_body_world_m_s.x(), 25.0, 1e-6);
  const auto after = (*truth)->state_at(3 * kNsPerS);
  ASSERT_TRUE(after.ok()) << after.error().message;
  EXPECT_FALSE(after->has_value());
  ASSERT_FALSE((*truth)->warnings().empty());
  EXPECT_THAT((*truth)->warnings().back(),
              HasSubstr("the flight ended at 2.000 s: the stamps of "));
}

TEST(RosTruth, WaitsOnWhenStampsGoBackBeforeTheFlight) {
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({"restart_early"});
  RosFlight flight = node.flight();
  flight.attitude_of_pose = true;
  const auto truth = fly_ros(flight, place_frame(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto state = (*truth)->state_at(kNsPerS);
  ASSERT_TRUE(state.ok()) << state.error().message;
  ASSERT_TRUE(*state);
  EXPECT_THAT((*truth)->warnings(),
              ::testing::ElementsAre(HasSubstr("stamps went back before the flight (1 time)")));
}

TEST(RosTruth, EndsWhenTheVehicleIsDisarmed) {
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({"disarm"});
  RosFlight flight = node.flight();
  flight.local = true;
  flight.attitude_of_pose = true;
  const auto truth = fly_ros(flight, place_frame(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto after = (*truth)->state_at(3 * kNsPerS);
  ASSERT_TRUE(after.ok()) << after.error().message;
  EXPECT_FALSE(after->has_value());
  ASSERT_FALSE((*truth)->warnings().empty());
  EXPECT_THAT((*truth)->warnings().back(), HasSubstr(" s: the vehicle was disarmed"));
  const std::vector<FlightEvent> events = (*truth)->take_events(3 * kNsPerS);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].kind, FlightEventKind::kMode);
  EXPECT_EQ(events[0].text, "AUTO");
  EXPECT_EQ(events[0].t_ns, 0);
  EXPECT_EQ(events[1].text, "RTL");
  EXPECT_EQ(events[1].t_ns, 1'500'000'000);
  EXPECT_EQ(events[2].kind, FlightEventKind::kOther);
  EXPECT_EQ(events[2].text, "disarmed");
  EXPECT_TRUE((*truth)->take_events(4 * kNsPerS).empty());
}

TEST(RosTruth, SaysWhatIsMissing) {
  ROS_MASTER_OR_SKIP();
  const MavrosNode node({"odd"});
  RosFlight flight = node.flight();
  flight.local = true;
  flight.patience = std::chrono::milliseconds(3000);
  const auto odd = fly_ros(flight, place_frame(), nullptr);
  ASSERT_FALSE(odd.ok());
  EXPECT_EQ(odd.error().code, ErrorCode::kIo);
  EXPECT_THAT(odd.error().message,
              HasSubstr("waiting for the flight's start: no valid PoseStamped or Odometry has come "
                        "on " +
                        flight.pose_topic + "; no valid Imu has come on " + flight.imu_topic +
                        "; another type came: sensor_msgs/Temperature on " + flight.imu_topic +
                        " within 3 s: "));
  EXPECT_THAT(odd.error().message, HasSubstr(flight.pose_topic + " has 1 publisher"));
  flight.global_topic = "/nobody/global";
  flight.local = false;
  flight.patience = std::chrono::milliseconds(200);
  const auto nobody = fly_ros(flight, place_frame(), nullptr);
  ASSERT_FALSE(nobody.ok());
  EXPECT_THAT(nobody.error().message, HasSubstr("/nobody/global has 0 publishers"));
  flight.global_topic = "not a topic";
  const auto bad = fly_ros(flight, place_frame(), nullptr);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(bad.error().message, HasSubstr("topic not a topic"));
}

TEST(RosTruth, NeedsAMaster) {
  RosFlight flight;
  flight.master_uri = "http://127.0.0.1:1";
  flight.patience = std::chrono::milliseconds(200);
  const auto truth = fly_ros(flight, place_frame(), nullptr);
  ASSERT_FALSE(truth.ok());
  flight.master_uri = "somewhere";
  const auto bad = fly_ros(flight, place_frame(), nullptr);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace overfly::flight::ros_live
