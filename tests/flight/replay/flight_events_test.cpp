// Events of a log as those of a flight.
#include "flight/replay/flight_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/time.hpp"

namespace overfly::flight {
namespace {

using logs::EventKind;

logs::LogEvent logged(double t_s, EventKind kind, const std::string& text, std::uint32_t boot = 0) {
  return {"", logs::LogTime{boot, ns_from_s(t_s)}, kind, text};
}

std::vector<std::string> texts_of(const std::vector<FlightEvent>& events) {
  std::vector<std::string> lines;
  for (const FlightEvent& event : events) {
    lines.push_back(std::to_string(event.t_ns / kNsPerS) + " " + to_string(event.kind) + " " +
                    event.text);
  }
  return lines;
}

TEST(FlightEvents, CountFromTheBeginningOfTheFlight) {
  logs::OpenedLog log;
  log.events = {logged(5, EventKind::kMode, "mode 0 (MANUAL)"),
                logged(5, EventKind::kText, "booted"),
                // An upload lists all items at once.
                logged(6, EventKind::kMission, "mission item 0, command 16"),
                logged(6, EventKind::kMission, "mission item 1, command 22"),
                logged(8, EventKind::kMission, "to mission item 1"),
                logged(20, EventKind::kMode, "mode 10 (AUTO)"),
                logged(21, EventKind::kCamera, "image 3"),
                logged(22, EventKind::kMission, "reached mission item 1"),
                logged(22, EventKind::kArming, "disarmed"),
                logged(31, EventKind::kMode, "mode 11 (RTL)")};
  EXPECT_THAT(texts_of(events_of(log, "GPS", 0, 10 * kNsPerS, 30 * kNsPerS)),
              ::testing::ElementsAre("0 mode MANUAL",
                                     "0 mission mission item 1",
                                     "10 mode AUTO",
                                     "12 event reached mission item 1",
                                     "12 event disarmed"));
}

TEST(FlightEvents, BeginASliceInTheStateBeforeIt) {
  logs::OpenedLog log;
  log.events_before = {logged(5, EventKind::kMode, "mode 4")};
  log.events = {logged(12, EventKind::kMode, "mode 7")};
  EXPECT_THAT(texts_of(events_of(log, "GPS", 0, 10 * kNsPerS, 30 * kNsPerS)),
              ::testing::ElementsAre("0 mode mode 4", "2 mode mode 7"));
}

TEST(FlightEvents, AreThoseOfOneRunOfTheClockAndOneVehicle) {
  logs::OpenedLog log;
  log.streams.emplace_back();
  log.streams.back().description.name = "2.1/GPS";
  log.streams.back().description.vehicle = "2.1";
  // The run that is flown need not be the one with the most messages.
  log.boots = {{"2.1", 0, 1, 99, 0}, {"2.1", 0, 1, 10, 1}, {"1.1", 0, 1, 999, 0}};
  for (std::uint32_t boot = 0; boot < 2; ++boot) {
    log.events.push_back(logged(1, EventKind::kMode, "of run " + std::to_string(boot), boot));
    log.events.back().vehicle = "2.1";
  }
  log.events.push_back(logged(1, EventKind::kMode, "of another", 1));
  log.events.back().vehicle = "1.1";
  EXPECT_THAT(texts_of(events_of(log, "2.1/GPS", 1, 0, 9 * kNsPerS)),
              ::testing::ElementsAre("1 mode of run 1"));
}

TEST(FlightEvents, KeepModesWhereTextsFlood) {
  logs::OpenedLog log;
  for (int i = 0; i < 5000; ++i) log.events.push_back(logged(i, EventKind::kText, "text"));
  log.events.push_back(logged(5001, EventKind::kMode, "mode 1"));
  const auto events = events_of(log, "GPS", 0, 0, 9000 * kNsPerS);
  EXPECT_EQ(events.size(), kMaxOtherEvents + 1);
  EXPECT_EQ(events.back().text, "mode 1");
}

/// A flight that stands still.
class Rest final : public TruthSource {
 public:
  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override { return kNsPerS; }
  [[nodiscard]] std::string description() const override { return "rest"; }
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override { return 77; }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* /*cancel*/) override {
    AircraftState state;
    state.t_ns = t_ns;
    return std::optional(state);
  }
};

TEST(FlightEvents, AreTakenOnceWhenTheirTimeHasCome) {
  const auto flight = with_records(std::make_unique<Rest>(),
                                   {{0, FlightEventKind::kMode, "a"},
                                    {5, FlightEventKind::kOther, "b"},
                                    {9, FlightEventKind::kMode, "c"}},
                                   nullptr);
  EXPECT_EQ(flight->description(), "rest");
  EXPECT_EQ(flight->log_start_ns(), 77);
  EXPECT_EQ((*flight->state_at(7))->t_ns, 7);
  EXPECT_EQ(flight->take_events(5).size(), 2U);
  EXPECT_TRUE(flight->take_events(8).empty());
  EXPECT_EQ(flight->take_events(100).front().text, "c");
}

}  // namespace
}  // namespace overfly::flight
