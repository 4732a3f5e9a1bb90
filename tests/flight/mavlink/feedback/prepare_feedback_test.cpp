#include "flight/mavlink/feedback/prepare_feedback.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/flight/mavlink/vehicle/fake_vehicle.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::HasSubstr;

constexpr GlobalPosition kWorld{10.0, 20.0, 300.0};

FeedbackOptions wanting(FeedbackMessage message) {
  FeedbackOptions options;
  options.message = message;
  return options;
}

TEST(PrepareFeedback, RefusesAHeightThatTheVehicleWouldFollow) {
  const auto prepared = [](FeedbackMessage message, double source, bool send_height) {
    testing::FakeVehicle vehicle;
    vehicle.origin_lat = 100'000'000;
    vehicle.parameters["EK3_SRC1_POSZ"] = {"EK3_SRC1_POSZ", source, 2};
    FeedbackOptions options = wanting(message);
    options.send_height = send_height;
    const Status status = prepare_feedback(vehicle, options, kWorld);
    return status.ok() ? std::string() : status.error().message;
  };
  // 1 barometer, 3 GPS, 6 external navigation.
  EXPECT_EQ(prepared(FeedbackMessage::kOdometry, 1, false), "");
  EXPECT_EQ(prepared(FeedbackMessage::kOdometry, 3, false), "");
  EXPECT_THAT(prepared(FeedbackMessage::kOdometry, 6, false),
              HasSubstr("feedback.send_height = false: vehicle 1.1 has EK3_SRC1_POSZ = 6, so its "
                        "height would follow the height in ODOMETRY"));
  EXPECT_THAT(prepared(FeedbackMessage::kVisionPositionEstimate, 6, false),
              HasSubstr("EK3_SRC1_POSZ = 6"));
  EXPECT_EQ(prepared(FeedbackMessage::kOdometry, 6, true), "");
  EXPECT_EQ(prepared(FeedbackMessage::kGpsInput, 6, false), "");
  EXPECT_THAT(prepared(FeedbackMessage::kGpsInput, 3, false), HasSubstr("EK3_SRC1_POSZ = 3"));
}

TEST(PrepareFeedback, GoesOnWithoutTheParameter) {
  testing::FakeVehicle vehicle;
  vehicle.origin_lat = 100'000'000;
  EXPECT_TRUE(prepare_feedback(vehicle, wanting(FeedbackMessage::kOdometry), kWorld).ok());
  // Other autopilots have no such parameter.
  testing::FakeVehicle px4;
  px4.autopilot = 12;
  px4.origin_lat = 100'000'000;
  EXPECT_TRUE(prepare_feedback(px4, wanting(FeedbackMessage::kOdometry), kWorld).ok());
  EXPECT_EQ(px4.received.count(20), 0U);
}

TEST(PrepareFeedback, NeedsAnOriginOrSetsIt) {
  testing::FakeVehicle vehicle;
  FeedbackOptions options = wanting(FeedbackMessage::kOdometry);
  options.send_height = true;
  const Status without = prepare_feedback(vehicle, options, kWorld);
  ASSERT_FALSE(without.ok());
  EXPECT_EQ(without.error().code, ErrorCode::kConflict);
  EXPECT_THAT(without.error().message, HasSubstr("give set_origin = true"));
  EXPECT_FALSE(vehicle.origin_lat);
  options.set_origin = true;
  EXPECT_TRUE(prepare_feedback(vehicle, options, kWorld).ok());
  EXPECT_EQ(vehicle.origin_lat, 100'000'000);
  // An origin that is there stays.
  testing::FakeVehicle flying;
  flying.origin_lat = -353'632'620;
  flying.loss = 0.2;
  EXPECT_TRUE(prepare_feedback(flying, options, kWorld).ok());
  EXPECT_EQ(flying.received.count(48), 0U);
  // GPS_INPUT needs none.
  testing::FakeVehicle gps;
  options.message = FeedbackMessage::kGpsInput;
  EXPECT_TRUE(prepare_feedback(gps, options, kWorld).ok());
  EXPECT_TRUE(gps.received.empty());
}

}  // namespace
}  // namespace overfly::flight::mavlink
