// Hunts flown by a program that a test writes: where they stop, what they keep, what they say.
#include "server/experiments/hunt/hunt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/experiments/hunt/hunt_output.hpp"
#include "server/record/run_lock.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using server::testing::options_for;
using server::testing::small_scenario;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A flight fails (every frame after 0.5 s is dropped) if its airspeed is above `fails_above_m_s_`.
class FlyHunt : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    fly_to("completed", {});
    fly_to("failed", {R"(faults=[{"kind":"dropped_frames","at_s":0.5}])"});
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }

  static Hunt hunt(Json fields = Json::object()) {
    fields.update({{"format_version", 1},
                   {"scenario", "course.json"},
                   {"estimator", {{"name", "p"}, {"type", "perfect"}}},
                   {"retries", 0}});
    if (!fields.contains("axes")) {
      fields["axes"] = {{{"path", "flight.course.airspeed_m_s"},
                         {"label", "Airspeed"},
                         {"unit", "m/s"},
                         {"from", 10},
                         {"to", 30}}};
    }
    return resolve_hunt(fields, fs::path(OVERFLY_SOURCE_DIR) / "scenarios", "").value();
  }

  Result<HuntResult> fly(const Hunt& hunt, double fails_above_m_s, std::size_t jobs = 1) {
    write_text(
        program(),
        "#!/bin/sh\nset -e\necho \"$2\" >> '" + calls().string() + "'\n" + before_ +
            "\nspeed=$(sed -n 's/.*\"airspeed_m_s\": \\([0-9.]*\\).*/\\1/p' \"$2\" | head -1)\n"
            "if [ \"$(echo \"$speed\" | awk '{print ($1 > " +
            std::to_string(fails_above_m_s) +
            ")}')\" = 1 ]; then from=failed; else from=completed; fi\ncp -r '" +
            shared_->path().string() + "'/$from \"$4\"\n");
    fs::permissions(program(), fs::perms::owner_all);
    HuntOptions options;
    options.flights.folder = folder();
    options.flights.program = program();
    options.flights.jobs = jobs;
    options.flights.frame_cache = frame_cache_;
    options.flights.cancel = &cancel_;
    options.progress = [this](const HuntResult& result) {
      EXPECT_TRUE(RunLock::held(folder())) << "also between rounds of flights";
      told_ = result.flights.size();
      if (told_ >= cancel_after_) cancel_ = true;
    };
    return fly_hunt(hunt, options);
  }
  [[nodiscard]] std::size_t calls_made() const {
    if (!fs::exists(calls())) return 0;
    const std::string text = read_text(calls());
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  [[nodiscard]] fs::path folder() const { return own_.path() / "out"; }
  [[nodiscard]] fs::path program() const { return own_.path() / "program"; }
  [[nodiscard]] fs::path calls() const { return own_.path() / "calls"; }

  FlightFrameCache frame_cache_;
  std::string before_;
  std::atomic<bool> cancel_{false};
  std::size_t cancel_after_ = 1000;
  std::size_t told_ = 0;

 private:
  static void fly_to(const std::string& name, std::vector<std::string> overrides) {
    overrides.emplace_back(R"(estimators=[{"name":"p","type":"perfect"}])");
    const auto run = run_scenario(small_scenario(overrides), options_for(shared_->path() / name));
    ASSERT_TRUE(run.ok()) << run.error().message;
  }

  inline static TemporaryFolder* shared_ = nullptr;
  TemporaryFolder own_;
};

double speed_of(const HuntedFlight& flight) {
  return flight.cell.values.at("flight.course.airspeed_m_s").get<double>();
}

TEST_F(FlyHunt, StopsAtTheFirstFailure) {
  const auto result = fly(hunt(), 20.0);
  ASSERT_TRUE(result.ok()) << result.error().message;
  ASSERT_TRUE(result->flights_to_failure().has_value());
  EXPECT_EQ(*result->flights_to_failure(), result->flights.size());
  EXPECT_EQ(calls_made(), result->flights.size());
  EXPECT_EQ(told_, result->flights.size());
  const HuntedFlight& worst = *result->worst();
  EXPECT_GT(speed_of(worst), 20.0);
  EXPECT_TRUE(worst.margin.failed);
  EXPECT_EQ(worst.outcome, evaluation::Outcome::kLost);
  EXPECT_THAT(result_text(worst), HasSubstr("fails: LOST at"));
  for (std::size_t i = 0; i + 1 < result->flights.size(); ++i) {
    EXPECT_LE(speed_of(result->flights[i]), 20.0);
    EXPECT_GT(result->flights[i].margin.value, 0.0);
  }
}

TEST_F(FlyHunt, FliesTheWholeBudgetIfAsked) {
  const auto result = fly(hunt({{"until", "flights"}, {"most_flights", 7}}), 20.0, 2);
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_EQ(result->flights.size(), 7U);
  EXPECT_EQ(calls_made(), 7U);
  EXPECT_TRUE(result->worst()->margin.failed);
}

/// Points that differ in the noise only share pictures, which the first one cannot know.
TEST_F(FlyHunt, KeepsPicturesWherePointsShareThem) {
  frame_cache_ = {folder() / "frames", 2.0, 1};
  before_ = "echo \"$*\" >> '" + (folder() / "words").string() + "'";
  const auto lines_with_cache = [&](const Json& fields) {
    fs::remove_all(folder());
    Json limits = fields;
    limits.update({{"until", "flights"}, {"most_flights", 3}});
    const auto result = fly(hunt(limits), 100.0);
    EXPECT_TRUE(result.ok()) << result.error().message;
    const std::string words = read_text(folder() / "words");
    std::size_t lines = 0;
    for (std::size_t at = 0; (at = words.find("--frame-cache-gib 2", at)) != words.npos; ++at) {
      ++lines;
    }
    return lines;
  };
  EXPECT_EQ(lines_with_cache(Json::object()), 0U);
  EXPECT_EQ(lines_with_cache({{"set", {{"camera.sensor", Json::object()}}},
                              {"axes",
                               {{{"path", "camera.sensor.read_noise_e"},
                                 {"label", "Noise"},
                                 {"unit", "e"},
                                 {"from", 0},
                                 {"to", 30}}}}}),
            2U);
}

TEST_F(FlyHunt, SaysWhenNothingFails) {
  const Hunt limits = hunt({{"most_flights", 4}});
  const auto result = fly(limits, 100.0);
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_EQ(result->flights.size(), 4U);
  EXPECT_FALSE(result->flights_to_failure().has_value());
  EXPECT_THAT(summary_text(limits, *result), HasSubstr("survives all of 4 flights"));
  EXPECT_TRUE(json_from(limits, *result).at("flights_to_failure").is_null());
}

TEST_F(FlyHunt, EndsWhenEveryPointWasFlown) {
  const auto result =
      fly(hunt({{"axes", {{{"path", "flight.course.airspeed_m_s"}, {"values", {10, 15, 20}}}}}}),
          100.0);
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_TRUE(result->exhausted);
  EXPECT_EQ(result->flights.size(), 3U);
}

/// The same command goes on and flies nothing twice.
TEST_F(FlyHunt, ContinuesAfterItWasCancelled) {
  const Hunt limits = hunt({{"most_flights", 8}});
  cancel_after_ = 5;
  const auto first = fly(limits, 100.0);
  ASSERT_TRUE(first.ok()) << first.error().message;
  EXPECT_TRUE(first->cancelled);
  EXPECT_EQ(first->flights.size(), 5U);
  cancel_ = false;
  cancel_after_ = 1000;
  const auto rest = fly(limits, 100.0);
  ASSERT_TRUE(rest.ok()) << rest.error().message;
  EXPECT_FALSE(rest->cancelled);
  EXPECT_EQ(rest->flights.size(), 8U);
  EXPECT_EQ(calls_made(), 8U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(rest->flights[i].run, first->flights[i].run);
}

TEST_F(FlyHunt, FliesEachPointWithSeveralSeeds) {
  const auto result = fly(hunt({{"most_flights", 7}, {"repeats", 3}}), 100.0);
  ASSERT_TRUE(result.ok()) << result.error().message;
  ASSERT_EQ(result->flights.size(), 6U) << "two points; no third one fits";
  EXPECT_EQ(result->flights[2].seed, result->flights[0].seed + 2);
  EXPECT_EQ(result->flights[0].cell.values, result->flights[2].cell.values);
  EXPECT_NE(result->flights[0].cell.values, result->flights[3].cell.values);
}

TEST_F(FlyHunt, DescribesItsFlights) {
  const Hunt limits = hunt({{"title", "Speed"}, {"method", "random"}});
  const auto result = fly(limits, 20.0);
  ASSERT_TRUE(result.ok()) << result.error().message;
  const Json json = json_from(limits, *result);
  EXPECT_EQ(json.at("title"), "Speed");
  EXPECT_EQ(json.at("method"), "random");
  EXPECT_EQ(json.at("estimator"), "p");
  EXPECT_EQ(json.at("axes").at(0).at("unit"), "m/s");
  EXPECT_EQ(json.at("flights").size(), result->flights.size());
  EXPECT_EQ(json.at("flights_to_failure"), result->flights.size());
  EXPECT_EQ(json.at("worst"), result->flights.size() - 1);
  EXPECT_EQ(json.at("flights").back().at("outcome"), "LOST");
  EXPECT_TRUE(fs::exists(folder() / json.at("flights").back().at("run").get<std::string>()));
  const std::string table = markdown_from(limits, *result);
  EXPECT_THAT(table, HasSubstr("| flight | Airspeed [m/s] | margin | result |"));
  EXPECT_THAT(table, HasSubstr("LOST at"));
  EXPECT_THAT(summary_text(limits, *result), HasSubstr("is the first one that estimator p fails"));
  const auto scenario = scenario_document(limits, *result->worst());
  ASSERT_TRUE(scenario.ok());
  EXPECT_THAT(scenario->at("title").get<std::string>(),
              HasSubstr("The worst flight found fails: LOST at"));
  EXPECT_EQ(scenario->at("flight").at("course").at("airspeed_m_s"), speed_of(*result->worst()));
}

TEST_F(FlyHunt, EndsWithTheReasonOfAFlightThatCannotBeFlown) {
  before_ = "echo 'error: no space' >&2; exit 1";
  const auto result = fly(hunt(), 20.0);
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().message, HasSubstr("flight.course.airspeed_m_s = "));
  EXPECT_THAT(result.error().message, HasSubstr("no space"));
}

TEST_F(FlyHunt, RefusesAFolderInWhichAnotherProcessWorks) {
  fs::create_directories(folder());
  const auto lock = RunLock::take(folder());
  ASSERT_TRUE(lock.ok());
  EXPECT_EQ(fly(hunt(), 20.0).error().code, ErrorCode::kConflict);
}

}  // namespace
}  // namespace overfly::server::experiments
