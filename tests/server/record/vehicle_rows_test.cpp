#include "server/record/rows/vehicle_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace overfly::server {
namespace {

using Json = nlohmann::json;

TEST(VehicleRows, AreReadAsTheyWereWritten) {
  VehicleStatus status;
  status.t_ns = 500'000'000;
  status.vehicle = "1.1";
  status.mode = "AUTO";
  status.armed = true;
  status.battery_v = 12.5;
  status.gps_fix = 3;
  status.messages_per_s = 51.5;
  status.lost_messages = 7;
  status.clock_rate = 1.25;
  status.gaps = 2;
  const Json written = json_from(status);
  EXPECT_EQ(written.at("battery_percent"), nullptr);
  const auto read = vehicle_status_from(written);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(json_from(*read), written);
  EXPECT_EQ(json_from(*vehicle_status_from(json_from(VehicleStatus()))),
            json_from(VehicleStatus()));
}

TEST(VehicleRows, NameTheFieldThatIsWrong) {
  Json row = json_from(VehicleStatus());
  row["satellites"] = -3;
  const auto read = vehicle_status_from(row);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, ::testing::HasSubstr("satellites = -3"));
  row.erase("satellites");
  EXPECT_FALSE(vehicle_status_from(row));
  EXPECT_FALSE(vehicle_status_from(Json(7)));
}

}  // namespace
}  // namespace overfly::server
