#include "flight/replay/late_start.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "core/earth/height_query.hpp"
#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/replay/flight_events.hpp"

namespace overfly::flight {
namespace {

std::unique_ptr<TruthSource> course() {
  return fly_course(CourseParameters{}, std::make_shared<FlatGround>(0.0)).value();
}

TEST(LateStart, HasTheStatesOfTheFlightAtALaterTime) {
  const auto whole = course();
  const auto late = started_late(course(), 7 * kNsPerS).value();
  EXPECT_EQ(*late->duration_ns(), *whole->duration_ns() - 7 * kNsPerS);
  EXPECT_EQ(late->description(), whole->description() + ", from 7 s on");
  for (const std::int64_t t_ns : {std::int64_t{0}, std::int64_t{1500000000}, 20 * kNsPerS}) {
    const AircraftState expected = **whole->state_at(t_ns + 7 * kNsPerS);
    const AircraftState state = **late->state_at(t_ns);
    EXPECT_EQ(state.t_ns, t_ns);
    EXPECT_EQ(state.T_world_body.translation, expected.T_world_body.translation);
    EXPECT_EQ(state.T_world_body.rotation.coeffs(), expected.T_world_body.rotation.coeffs());
    EXPECT_EQ(state.v_body_world_m_s, expected.v_body_world_m_s);
  }
  EXPECT_FALSE(*late->state_at(*late->duration_ns() + 1));
}

TEST(LateStart, TheModeInForceComesAtItsStart) {
  const std::vector<FlightEvent> events = {{0, FlightEventKind::kMode, "TAKEOFF"},
                                           {1 * kNsPerS, FlightEventKind::kOther, "armed"},
                                           {2 * kNsPerS, FlightEventKind::kMode, "AUTO"},
                                           {5 * kNsPerS, FlightEventKind::kOther, "text"},
                                           {6 * kNsPerS, FlightEventKind::kMode, "RTL"}};
  const auto late = started_late(with_records(course(), events, nullptr), 5 * kNsPerS).value();
  const auto first = late->take_events(0);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0].text, "AUTO");
  EXPECT_EQ(first[0].t_ns, 0);
  EXPECT_EQ(first[1].text, "text");
  const auto next = late->take_events(1 * kNsPerS);
  ASSERT_EQ(next.size(), 1U);
  EXPECT_EQ(next[0].text, "RTL");
  EXPECT_EQ(next[0].t_ns, 1 * kNsPerS);
}

TEST(LateStart, MustBeBeforeTheEndOfTheFlight) {
  const auto late = started_late(course(), 1000 * kNsPerS);
  ASSERT_FALSE(late);
  EXPECT_THAT(late.error().message, ::testing::HasSubstr(" = 1000: the flight ends at "));
}

}  // namespace
}  // namespace overfly::flight
