// The parts of a flight in which a failure is looked for again.
#include "server/experiments/explain/critical_part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace overfly::server::experiments {
namespace {

using evaluation::Outcome;
using Json = nlohmann::json;

evaluation::Score failed(Outcome outcome, double at_s) {
  evaluation::Score score;
  score.outcome = outcome;
  score.outcome_time_s = at_s;
  score.initialised_at_s = 1.0;
  return score;
}

TEST(CriticalPart, IsShortAtFirstAndBeginsWithTheFlightInTheEnd) {
  const auto parts = critical_parts(failed(Outcome::kReset, 40.0), 60.0);
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].from_s, 30.0);
  EXPECT_EQ(parts[1].from_s, 10.0);
  EXPECT_EQ(parts[2].from_s, 0.0);
  for (const CriticalPart& part : parts) EXPECT_EQ(part.to_s, 46.0);
}

/// Two losses, of which only the second is long enough for LOST, have the instant of the first.
TEST(CriticalPart, OfALostFlightIsTheWholeFlightAtLast) {
  const auto parts = critical_parts(failed(Outcome::kLost, 10.0), 60.0);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].to_s, 16.0);
  EXPECT_EQ(parts[1].from_s, 0.0);
  EXPECT_EQ(parts[1].to_s, 60.0);
}

/// The random numbers of a fault depend on its place in the list.
TEST(CriticalPart, KeepsThePlacesOfFaultsBehindThoseThatAreOver) {
  const Json document = {
      {"flight", {{"course", Json::object()}}},
      {"estimators", Json::array({{{"name", "a"}}})},
      {"faults",
       Json::array({{{"kind", "blackout"}, {"at_s", 2}, {"duration_s", 1}},
                    {{"kind", "dropped_frames"}, {"at_s", 12}, {"probability", 0.5}},
                    {{"kind", "dirt"}, {"at_s", 3}, {"duration_s", 1}}})}};
  const Json faults = part_document(document, "/runs/a", 0, {10.0, 20.0, 1.0}).at("faults");
  ASSERT_EQ(faults.size(), 2U) << "nothing is behind the last one";
  EXPECT_EQ(faults[0].at("at_s"), 86400.0);
  EXPECT_EQ(faults[1].at("kind"), "dropped_frames");
  EXPECT_EQ(faults[1].at("at_s"), 2.0);
}

}  // namespace
}  // namespace overfly::server::experiments
