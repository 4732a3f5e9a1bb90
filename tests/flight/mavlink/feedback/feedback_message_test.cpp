// Estimates as messages against closed forms, GeographicLib and an independent decoder.
#include "flight/mavlink/feedback/feedback_message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <map>
#include <sstream>

#include "core/measure/sha256.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/mavlink/frame.hpp"
#include "tests/flight/mavlink/peer/peer_script.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::HasSubstr;

constexpr double kPlaceLatDeg = -35.363262;
constexpr double kPlaceLonDeg = 149.165237;
constexpr double kOriginEllipsoidM = 603.3;
constexpr double kGeoidM = 19.3;

FeedbackPlace place() {
  FeedbackPlace place{LocalFrame(geodetic_from_deg(kPlaceLatDeg, kPlaceLonDeg, kOriginEllipsoidM)),
                      kGeoidM,
                      3,
                      logs::LocalOrigin{kPlaceLatDeg, kPlaceLonDeg, kOriginEllipsoidM - kGeoidM},
                      std::nullopt,
                      0.0,
                      0};
  return place;
}

/// 40 m east, 30 m north and 20 m above the origin; nose to the north-east (yaw 45 deg), 10 deg up,
/// right wing 20 deg down; flies at 14 m/s north, 15 m/s east and climbs with 2 m/s.
FeedbackSample sample() {
  FeedbackSample sample;
  sample.t_ns = 123'456'789'000;
  sample.T_world_body.translation = {40.0, 30.0, 20.0};
  sample.T_world_body.rotation =
      R_world_body_from({rad_from_deg(20.0), rad_from_deg(10.0), rad_from_deg(45.0)});
  sample.v_world_m_s = Eigen::Vector3d(15.0, 14.0, 2.0);
  sample.reset_counter = 7;
  return sample;
}

FeedbackOptions options_for(FeedbackMessage message, bool send_height = true) {
  FeedbackOptions options;
  options.message = message;
  options.send_height = send_height;
  return options;
}

PayloadReader reader(const std::optional<FeedbackPayload>& message) {
  return PayloadReader(message->payload.bytes());
}

TEST(FeedbackMessage, VisionPositionEstimateIsNorthEastDown) {
  const auto message =
      feedback_message(options_for(FeedbackMessage::kVisionPositionEstimate), sample(), place());
  ASSERT_TRUE(message);
  EXPECT_EQ(message->id, MessageId::kVisionPositionEstimate);
  const PayloadReader payload = reader(message);
  EXPECT_EQ(payload.at<std::uint64_t>(0), 123'456'789U);
  // ArduPilot's metres differ from WGS84's by up to 0.5 %.
  EXPECT_NEAR(payload.at<float>(8), 30.0, 0.15);
  EXPECT_NEAR(payload.at<float>(12), 40.0, 0.20);
  EXPECT_NEAR(payload.at<float>(16), -20.0, 1e-3);
  // 50 m from the origin, north-east-down turns by less than 0.0005 deg.
  EXPECT_NEAR(payload.at<float>(20), rad_from_deg(20.0), 1e-5);
  EXPECT_NEAR(payload.at<float>(24), rad_from_deg(10.0), 1e-5);
  EXPECT_NEAR(payload.at<float>(28), rad_from_deg(45.0), 1e-5);
  EXPECT_TRUE(std::isnan(payload.at<float>(32))) << "an unknown covariance";
  EXPECT_EQ(payload.at<std::uint8_t>(116), 7);
}

TEST(FeedbackMessage, PositionsComeBackFromTheVehiclesOwnGrid) {
  for (const auto& [autopilot, grid] : {std::pair(std::uint8_t{3}, logs::LocalGrid::kArduPilot),
                                        std::pair(std::uint8_t{12}, logs::LocalGrid::kPx4)}) {
    FeedbackPlace at = place();
    at.autopilot = autopilot;
    at.origin = logs::LocalOrigin{kPlaceLatDeg - 0.01, kPlaceLonDeg + 0.02, 584.0, grid};
    FeedbackSample far = sample();
    far.T_world_body.translation = {2500.0, -1800.0, 310.0};
    const auto message = feedback_message(options_for(FeedbackMessage::kOdometry), far, at);
    ASSERT_TRUE(message);
    const PayloadReader payload = reader(message);
    const Eigen::Vector3d ned(payload.at<float>(8), payload.at<float>(12), payload.at<float>(16));
    const Eigen::Vector3d back = logs::geodetic_from_local(*at.origin, ned);
    const GeographicLib::LocalCartesian reference(kPlaceLatDeg, kPlaceLonDeg, kOriginEllipsoidM);
    double lat_deg = 0.0;
    double lon_deg = 0.0;
    double alt_m = 0.0;
    reference.Reverse(2500.0, -1800.0, 310.0, lat_deg, lon_deg, alt_m);
    EXPECT_NEAR(back.x(), lat_deg, 3e-9);
    EXPECT_NEAR(back.y(), lon_deg, 3e-9);
    EXPECT_NEAR(back.z(), alt_m - kGeoidM, 1e-3);
  }
}

TEST(FeedbackMessage, OdometryHasTheFramesThatArduPilotAccepts) {
  FeedbackOptions options = options_for(FeedbackMessage::kOdometry);
  options.position_std_dev_m = 2.0;
  options.attitude_std_dev_rad = 0.1;
  options.velocity_std_dev_m_s = 0.5;
  const auto message = feedback_message(options, sample(), place());
  ASSERT_TRUE(message);
  const PayloadReader payload = reader(message);
  EXPECT_EQ(payload.at<std::uint8_t>(228), 20);  // MAV_FRAME_LOCAL_FRD
  EXPECT_EQ(payload.at<std::uint8_t>(229), 12);  // MAV_FRAME_BODY_FRD
  EXPECT_EQ(payload.at<std::uint8_t>(230), 7);
  EXPECT_EQ(payload.at<std::uint8_t>(231), 2);  // MAV_ESTIMATOR_TYPE_VISION
  EXPECT_EQ(payload.at<std::int8_t>(232), 0);   // the quality is unknown
  // q = w, x, y, z of yaw 45, pitch 10, roll 20 deg (Z-Y-X), by half angles.
  const double cy = std::cos(rad_from_deg(22.5)), sy = std::sin(rad_from_deg(22.5));
  const double cp = std::cos(rad_from_deg(5.0)), sp = std::sin(rad_from_deg(5.0));
  const double cr = std::cos(rad_from_deg(10.0)), sr = std::sin(rad_from_deg(10.0));
  EXPECT_NEAR(payload.at<float>(20), cr * cp * cy + sr * sp * sy, 1e-5);
  EXPECT_NEAR(payload.at<float>(24), sr * cp * cy - cr * sp * sy, 1e-5);
  EXPECT_NEAR(payload.at<float>(28), cr * sp * cy + sr * cp * sy, 1e-5);
  EXPECT_NEAR(payload.at<float>(32), cr * cp * sy - sr * sp * cy, 1e-5);
  // The velocity in the body's axes: the transposed rows of the direction cosine matrix.
  const Eigen::Vector3d v(payload.at<float>(36), payload.at<float>(40), payload.at<float>(44));
  const double north = 14.0, east = 15.0, down = -2.0;
  const double c = std::cos(rad_from_deg(45.0));
  EXPECT_NEAR(
      v.x(),
      std::cos(rad_from_deg(10.0)) * c * (north + east) - std::sin(rad_from_deg(10.0)) * down,
      1e-3);
  EXPECT_NEAR(v.norm(), std::sqrt(north * north + east * east + down * down), 1e-4);
  EXPECT_TRUE(std::isnan(payload.at<float>(48))) << "the rates are unknown";
  // Diagonals of the upper triangles: elements 0, 6, 11 and 15, 18, 20.
  for (const std::size_t element : {0, 6, 11}) {
    EXPECT_FLOAT_EQ(payload.at<float>(60 + 4 * element), 4.0F);
    EXPECT_FLOAT_EQ(payload.at<float>(144 + 4 * element), 0.25F);
  }
  for (const std::size_t element : {15, 18, 20}) {
    EXPECT_FLOAT_EQ(payload.at<float>(60 + 4 * element), 0.01F);
    EXPECT_TRUE(std::isnan(payload.at<float>(144 + 4 * element)));
  }
  for (const std::size_t element : {1, 2, 3, 4, 5, 7, 10, 12, 14, 16, 17, 19}) {
    EXPECT_EQ(payload.at<float>(60 + 4 * element), 0.0F);
  }
  FeedbackPlace px4 = place();
  px4.autopilot = 12;
  EXPECT_EQ(reader(feedback_message(options, sample(), px4)).at<std::uint8_t>(228), 1);
}

// ArduPlane's height follows ODOMETRY's z when EK3_SRC1_POSZ says so, and a NaN there drops the
// position. Without the estimate's height, z is what the vehicle itself believes.
TEST(FeedbackMessage, WithoutHeightZIsTheVehiclesOwn) {
  FeedbackPlace at = place();
  at.own_alt_msl_m = 584.0 + 77.0;
  at.own_v_down_m_s = 0.75;
  for (const FeedbackMessage kind :
       {FeedbackMessage::kVisionPositionEstimate, FeedbackMessage::kOdometry}) {
    FeedbackSample wrong = sample();
    const auto z_of = [&](double up_m, bool send_height) {
      wrong.T_world_body.translation.z() = up_m;
      const auto message = feedback_message(options_for(kind, send_height), wrong, at);
      EXPECT_TRUE(message);
      return reader(message).at<float>(16);
    };
    // With the height, an estimate whose scale is off by a factor of three takes the vehicle along.
    EXPECT_NEAR(z_of(20.0, true), -20.0, 0.01);
    EXPECT_NEAR(z_of(60.0, true), -60.0, 0.01);
    EXPECT_NEAR(z_of(20.0, false), -77.0, 0.01);
    EXPECT_NEAR(z_of(60.0, false), -77.0, 0.01);
    // The horizontal position is the estimate's in both cases.
    EXPECT_NEAR(
        reader(feedback_message(options_for(kind, false), sample(), at)).at<float>(8), 30.0, 0.15);
  }
  const auto odometry =
      feedback_message(options_for(FeedbackMessage::kOdometry, false), sample(), at);
  const Eigen::Vector3d v_body(reader(odometry).at<float>(36),
                               reader(odometry).at<float>(40),
                               reader(odometry).at<float>(44));
  const Eigen::Quaterniond R_ned_body =
      logs::R_ned_body_from({rad_from_deg(20.0), rad_from_deg(10.0), rad_from_deg(45.0)});
  EXPECT_LT((R_ned_body * v_body - Eigen::Vector3d(14.0, 15.0, 0.75)).norm(), 1e-3);
  // A vehicle whose height is unknown gets no message.
  at.own_alt_msl_m.reset();
  EXPECT_FALSE(feedback_message(options_for(FeedbackMessage::kOdometry, false), sample(), at));
}

TEST(FeedbackMessage, NeedsTheOriginOfLocalPositions) {
  FeedbackPlace at = place();
  at.origin.reset();
  EXPECT_FALSE(feedback_message(options_for(FeedbackMessage::kOdometry), sample(), at));
  EXPECT_FALSE(
      feedback_message(options_for(FeedbackMessage::kVisionPositionEstimate), sample(), at));
  EXPECT_TRUE(feedback_message(options_for(FeedbackMessage::kGpsInput), sample(), at));
}

TEST(FeedbackMessage, GpsInputIsAReceiversFix) {
  FeedbackOptions options = options_for(FeedbackMessage::kGpsInput);
  options.position_std_dev_m = 3.0;
  options.velocity_std_dev_m_s = 0.5;
  FeedbackPlace at = place();
  at.utc_ns = 1'483'228'800'250'000'000;  // 2017-01-01T00:00:00.25Z
  const auto message = feedback_message(options, sample(), at);
  ASSERT_TRUE(message);
  const PayloadReader payload = reader(message);
  const GeographicLib::LocalCartesian reference(kPlaceLatDeg, kPlaceLonDeg, kOriginEllipsoidM);
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double alt_m = 0.0;
  reference.Reverse(40.0, 30.0, 20.0, lat_deg, lon_deg, alt_m);
  EXPECT_EQ(payload.at<std::uint64_t>(0), 123'456'789U);
  EXPECT_EQ(payload.at<std::uint16_t>(58), 1930);
  EXPECT_EQ(payload.at<std::uint32_t>(8), 18'250U);
  EXPECT_EQ(payload.at<std::int32_t>(12), std::lround(1e7 * lat_deg));
  EXPECT_EQ(payload.at<std::int32_t>(16), std::lround(1e7 * lon_deg));
  EXPECT_NEAR(payload.at<float>(20), alt_m - kGeoidM, 1e-3);
  EXPECT_NEAR(payload.at<float>(32), 14.0, 1e-3);
  EXPECT_NEAR(payload.at<float>(36), 15.0, 1e-3);
  EXPECT_NEAR(payload.at<float>(40), -2.0, 1e-3);
  EXPECT_EQ(payload.at<float>(44), 0.5F);
  EXPECT_EQ(payload.at<float>(48), 3.0F);
  EXPECT_EQ(payload.at<std::uint16_t>(56), 0) << "nothing is to be ignored";
  EXPECT_EQ(payload.at<std::uint8_t>(61), 3);
  EXPECT_EQ(payload.at<std::uint16_t>(63), 4500);
}

TEST(FeedbackMessage, GpsInputSaysWhatIsToBeIgnored) {
  constexpr int kAlt = 1, kVdop = 4, kVelHoriz = 8, kVelVert = 16, kSpeed = 32, kHoriz = 64,
                kVert = 128;
  FeedbackPlace at = place();
  at.own_alt_msl_m = 700.0;
  FeedbackOptions options = options_for(FeedbackMessage::kGpsInput, false);
  const auto flags = [&](const FeedbackSample& of) {
    const auto message = feedback_message(options, of, at);
    EXPECT_EQ(reader(message).at<float>(20), 700.0F);
    return static_cast<int>(reader(message).at<std::uint16_t>(56));
  };
  EXPECT_EQ(flags(sample()), kAlt | kVdop | kVelVert | kSpeed | kHoriz | kVert);
  FeedbackSample without_velocity = sample();
  without_velocity.v_world_m_s.reset();
  EXPECT_EQ(flags(without_velocity), kAlt | kVdop | kVelHoriz | kVelVert | kSpeed | kHoriz | kVert);
  options.position_std_dev_m = 3.0;
  options.velocity_std_dev_m_s = 0.5;
  EXPECT_EQ(flags(sample()), kAlt | kVdop | kVelVert | kVert);
  // North is 36000: 0 stands for unknown.
  FeedbackSample north = sample();
  north.T_world_body.rotation = R_world_body_from({});
  EXPECT_EQ(reader(feedback_message(options, north, at)).at<std::uint16_t>(63), 36000);
}

/// The fields that the peer prints of a frame.
std::map<std::string, std::string> fields_of(const std::string& line) {
  std::map<std::string, std::string> fields;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) fields[word.substr(0, equals)] = word.substr(equals + 1);
  }
  return fields;
}

TEST(FeedbackMessage, IsReadByAnIndependentImplementation) {
  std::string frames;
  FeedbackPlace at = place();
  at.utc_ns = 1'483'228'800'250'000'000;
  for (const FeedbackMessage kind : {FeedbackMessage::kVisionPositionEstimate,
                                     FeedbackMessage::kOdometry,
                                     FeedbackMessage::kGpsInput}) {
    FeedbackOptions options = options_for(kind);
    options.position_std_dev_m = 2.0;
    options.attitude_std_dev_rad = 0.1;
    const auto message = feedback_message(options, sample(), at);
    ASSERT_TRUE(message);
    const auto bytes = encode_frame({Version::kTwo,
                                     0,
                                     255,
                                     190,
                                     static_cast<std::uint32_t>(message->id),
                                     false,
                                     message->payload.bytes()});
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    frames += hex_text(*bytes) + " ";
  }
  const std::vector<std::string> lines =
      testing::lines_of_script("peer.cjs", "read " + std::string(64, '0') + " " + frames);
  if (lines.empty()) GTEST_SKIP() << testing::kPeerNotInstalled;
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], HasSubstr("VISION_POSITION_ESTIMATE"));
  auto vision = fields_of(lines[0]);
  EXPECT_EQ(vision["usec"], "123456789");
  EXPECT_NEAR(std::stod(vision["x"]), 30.0, 0.15);
  EXPECT_NEAR(std::stod(vision["y"]), 40.0, 0.20);
  EXPECT_NEAR(std::stod(vision["z"]), -20.0, 1e-3);
  EXPECT_NEAR(std::stod(vision["yaw"]), rad_from_deg(45.0), 1e-5);
  EXPECT_THAT(vision["covariance"], ::testing::StartsWith("4,0,0,0,0,0,4,0,0,0,0,4,"));
  EXPECT_EQ(vision["reset_counter"], "7");
  EXPECT_THAT(lines[1], HasSubstr("ODOMETRY"));
  auto odometry = fields_of(lines[1]);
  EXPECT_EQ(odometry["time_usec"], "123456789");
  EXPECT_EQ(odometry["frame_id"], "20");
  EXPECT_EQ(odometry["child_frame_id"], "12");
  EXPECT_EQ(odometry["reset_counter"], "7");
  EXPECT_EQ(odometry["estimator_type"], "2");
  EXPECT_NEAR(std::stod(odometry["z"]), -20.0, 1e-3);
  EXPECT_EQ(odometry["rollspeed"], "NaN");
  EXPECT_THAT(odometry["velocity_covariance"], ::testing::StartsWith("NaN,"));
  EXPECT_THAT(lines[2], HasSubstr("GPS_INPUT"));
  auto gps = fields_of(lines[2]);
  EXPECT_EQ(gps["time_week"], "1930");
  EXPECT_EQ(gps["time_week_ms"], "18250");
  EXPECT_NEAR(std::stod(gps["lat"]), 1e7 * kPlaceLatDeg + 2700.0, 20.0);
  EXPECT_EQ(gps["ignore_flags"], "32");
  EXPECT_EQ(gps["fix_type"], "3");
  EXPECT_EQ(gps["yaw"], "4500");
}

}  // namespace
}  // namespace overfly::flight::mavlink
