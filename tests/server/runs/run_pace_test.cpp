// The time that a flight still takes.
#include "server/runs/run_pace.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

using std::chrono::seconds;

const RunPace::Time kStart{};

TEST(RunPace, IsUnknownAtFirst) {
  RunPace pace;
  EXPECT_FALSE(pace.left_s(1000).has_value());
  pace.add(kStart, 0);  // the world is being opened
  pace.add(kStart + seconds(100), 10);
  EXPECT_FALSE(pace.left_s(1000).has_value());
  pace.add(kStart + seconds(101), 20);
  EXPECT_FALSE(pace.left_s(1000).has_value()) << "one second says little";
}

TEST(RunPace, DividesTheFramesLeftByTheirRate) {
  RunPace pace;
  for (int i = 0; i <= 10; ++i) pace.add(kStart + seconds(i), 1 + 20 * i);
  EXPECT_DOUBLE_EQ(pace.left_s(1201).value(), 50.0);
  EXPECT_DOUBLE_EQ(pace.left_s(201).value(), 0.0);
  EXPECT_DOUBLE_EQ(pace.left_s(100).value(), 0.0);
  EXPECT_FALSE(pace.left_s(0).has_value()) << "the flight's length is not known";
}

TEST(RunPace, ForgetsHowFastTheFlightWasBefore) {
  RunPace pace;
  int frames = 1;
  for (int i = 0; i < 100; ++i) pace.add(kStart + seconds(i), frames += 100);
  for (int i = 100; i < 200; ++i) pace.add(kStart + seconds(i), frames += 10);
  EXPECT_NEAR(pace.left_s(frames + 600).value(), 60.0, 1e-9);
}

TEST(RunPace, SaysNothingOfAFlightThatStands) {
  RunPace pace;
  for (int i = 0; i < 200; ++i) pace.add(kStart + seconds(i), 5);
  EXPECT_FALSE(pace.left_s(1000).has_value());
}

}  // namespace
}  // namespace overfly::server
