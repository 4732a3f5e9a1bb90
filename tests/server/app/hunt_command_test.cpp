// overfly hunt: a whole hunt by the program itself, and the flight that it found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class HuntCommand : public CommandLine {
 protected:
  /// The drifting estimator's error is its drift times the distance flown: 1.4 m RMSE at most,
  /// which only the fastest flights with the largest drift reach.
  static std::vector<std::string> arguments(const std::string& out,
                                            const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"hunt",
                                   scenario_file(),
                                   "--out",
                                   path(out),
                                   "--set",
                                   R"(estimators=[{"name": "d", "type": "drifting"}])",
                                   "--axis",
                                   "estimators.0.parameters.drift=0:0.1",
                                   "--axis",
                                   "flight.course.airspeed_m_s=15:25",
                                   "--position-rmse-limit-m",
                                   "1.1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static Json hunt_of(const std::string& out) {
    return Json::parse(read_text(path(out + "/hunt.json")));
  }
};

TEST_F(HuntCommand, FindsAFailureThatCanBeFlownAgain) {
  SKIP_WITHOUT_EGL();
  const Outcome hunt = overfly_program(arguments("h1"));
  ASSERT_EQ(hunt.exit_code, 0) << hunt.err;
  EXPECT_THAT(hunt.out, HasSubstr("| flight | estimators.0.parameters.drift | "));
  EXPECT_THAT(hunt.out, HasSubstr("is the first one that estimator d fails"));
  const Json found = hunt_of("h1");
  const Json& worst = found.at("flights").at(found.at("worst").get<std::size_t>());
  EXPECT_TRUE(worst.at("failed"));
  EXPECT_EQ(found.at("flights_to_failure"), found.at("flights").size());
  // The same command flies nothing again and says the same.
  const Outcome again = overfly_program(arguments("h1", {"--quiet"}));
  EXPECT_EQ(again.out, hunt.out);
  // The scenario file of the worst flight gives the same failure.
  const Outcome flown =
      overfly_program({"run", path("h1/worst.json"), "--out", path("r1"), "--quiet"});
  ASSERT_EQ(flown.exit_code, 0) << flown.err;
  const auto rmse_m = [](const std::string& run) {
    const Json metrics = Json::parse(read_text(run + "/metrics.json"));
    return metrics.at("estimators").at("d").at("alignments").at("init_scale").at("position_rmse_m");
  };
  EXPECT_GT(rmse_m(path("r1")), 1.1);
  EXPECT_EQ(rmse_m(path("r1")), rmse_m(path("h1/" + worst.at("run").get<std::string>())));
}

TEST_F(HuntCommand, ContinuesAfterItWasCancelled) {
  SKIP_WITHOUT_EGL();
  const std::vector<std::string> more{"--all", "--flights", "12", "--json"};
  const auto lines = [] {
    const std::string file = path("h2/results.jsonl");
    const std::string text = fs::exists(file) ? read_text(file) : "";
    return std::count(text.begin(), text.end(), '\n');
  };
  {
    RunningProgram program(arguments("h2", more), path(""));
    while (program.running() && lines() < 3) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    program.signal(SIGINT);
    EXPECT_EQ(program.wait(), 3) << program.err();
    EXPECT_THAT(program.err(), HasSubstr("the same command continues"));
    const Json stopped = Json::parse(program.out());
    EXPECT_TRUE(stopped.at("cancelled"));
    EXPECT_LT(stopped.at("flights").size(), 12U);
  }
  const Outcome rest = overfly_program(arguments("h2", more));
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(Json::parse(rest.out).at("flights").size(), 12U);
  EXPECT_EQ(lines(), 12) << "no flight was flown twice";
  EXPECT_THAT(rest.err, HasSubstr("100 % 12 of at most 12 flights"));
}

TEST_F(HuntCommand, ReadsAHuntFileWhoseFieldsOptionsReplace) {
  SKIP_WITHOUT_EGL();
  write_text(path("hunt.json"),
             R"({"format_version": 1, "scenario": "small.json", "title": "Small", "most_flights": 9,
                 "axes": [{"path": "flight.course.airspeed_m_s", "values": [15, 20, 25]}]})");
  const Outcome hunt = overfly_program({"hunt",
                                        path("hunt.json"),
                                        "--out",
                                        path("h3"),
                                        "--flights",
                                        "2",
                                        "--method",
                                        "random",
                                        "--seed",
                                        "4"});
  ASSERT_EQ(hunt.exit_code, 0) << hunt.err;
  EXPECT_THAT(hunt.out, HasSubstr("Estimator perfect survives all of 2 flights"));
  const Json found = hunt_of("h3");
  EXPECT_EQ(found.at("title"), "Small");
  EXPECT_EQ(found.at("method"), "random");
  EXPECT_EQ(found.at("seed"), 4);
  EXPECT_TRUE(found.at("flights_to_failure").is_null());
  EXPECT_TRUE(fs::exists(path("h3/worst.json"))) << "the flight with the lowest margin";
}

TEST_F(HuntCommand, NamesWhatIsInvalid) {
  const auto expect = [](const std::vector<std::string>& words, const std::string& message) {
    std::vector<std::string> all{"hunt", scenario_file(), "--out", path("h4")};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = overfly_program(all);
    EXPECT_EQ(outcome.exit_code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  };
  expect({}, "a scenario needs limits: --axis PATH=FROM:TO");
  expect({"--axis", "flight.course.airspeed_m_s"}, "must be PATH=FROM:TO or PATH=FROM:TO:STEP");
  expect({"--axis", "flight.course.airspeed_m_s=-5:20"}, "flight.course.airspeed_m_s = -5");
  expect({"--axis", "flight.course.airspeed_m_s=15:20", "--estimator", "x"},
         "estimator = x: must be one of perfect");
  expect({"--axis", "flight.course.airspeed_m_s=15:20", "--flights", "501"}, "--flights");
  EXPECT_FALSE(fs::exists(path("h4")));
}

TEST_F(HuntCommand, DoesNotReplaceWhatItReadsOrASweep) {
  fs::create_directories(path("h5"));
  const std::string document = R"({"format_version": 1, "scenario": "../small.json",
    "axes": [{"path": "flight.course.airspeed_m_s", "values": [15, 20, 25]}]})";
  write_text(path("h5/hunt.json"), document);
  const Outcome itself = overfly_program({"hunt", path("h5/hunt.json"), "--out", path("h5")});
  EXPECT_EQ(itself.exit_code, 2);
  EXPECT_THAT(itself.err, HasSubstr("h5/hunt.json: is the file of scenario"));
  EXPECT_EQ(read_text(path("h5/hunt.json")), document);
  fs::create_directories(path("h6"));
  write_text(path("h6/sweep.json"), "{}");
  const Outcome sweep = overfly_program({"hunt", path("h5/hunt.json"), "--out", path("h6")});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_THAT(sweep.err, HasSubstr("h6: is the folder of a sweep"));
  EXPECT_EQ(read_text(path("h6/sweep.json")), "{}");
}

}  // namespace
}  // namespace overfly::testing
