// overfly predict: what it prints and writes, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(CommandLine, PredictWritesWhatItPrints) {
  const Outcome predicted = overfly_program({"predict",
                                             scenario_file(),
                                             "--set",
                                             "duration_s=3",
                                             "--out",
                                             path("predicted"),
                                             "--jobs",
                                             "2"});
  ASSERT_EQ(predicted.exit_code, 0) << predicted.err;
  EXPECT_THAT(predicted.out, HasSubstr("The estimator is lost in this flight of 3.0 s with a "));
  EXPECT_THAT(predicted.out, HasSubstr("Straight and level at "));
  EXPECT_THAT(predicted.out, HasSubstr("predict.html"));
  EXPECT_THAT(predicted.err, HasSubstr("the map"));
  EXPECT_THAT(read_text(path("predicted/predict.html")), HasSubstr("Map of risk"));
  const Json document = Json::parse(read_text(path("predicted/predict.json")));
  EXPECT_EQ(document.at("instants").size(), 7U);
  EXPECT_EQ(document.at("risk"), document.at("instants").back().at("risk_so_far"));
  EXPECT_EQ(document.at("map").at("risk_10_s").size(),
            document.at("map").at("columns").get<std::size_t>() *
                document.at("map").at("rows").get<std::size_t>());
  const Outcome again =
      overfly_program({"predict", scenario_file(), "--set", "duration_s=3", "--json", "--quiet"});
  EXPECT_EQ(Json::parse(again.out), document);
  EXPECT_EQ(again.err.find("the map"), std::string::npos);
}

TEST_F(CommandLine, PredictRefusesWhatItCannotDo) {
  const Outcome absent = overfly_program({"predict", path("absent.json")});
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_THAT(absent.err, HasSubstr("absent.json"));
  const Outcome camera = overfly_program({"predict", scenario_file(), "--camera", "none"});
  EXPECT_EQ(camera.exit_code, 2);
  EXPECT_THAT(camera.err, HasSubstr("--camera = \"none\""));
  const Outcome live = overfly_program({"predict",
                                        scenario_file(),
                                        "--set",
                                        R"(flight={"mavlink":{"link":"udp-listen:127.0.0.1:1"}})"});
  EXPECT_EQ(live.exit_code, 2);
  EXPECT_THAT(live.err, HasSubstr("a live vehicle: must be known before it is flown"));
  EXPECT_EQ(overfly_program({"predict", scenario_file(), "--rate", "0"}).exit_code, 2);
  EXPECT_EQ(overfly_program({"predict", scenario_file(), "--map-km", "26"}).exit_code, 2);
  write_text(path("file"), "");
  const Outcome taken =
      overfly_program({"predict", scenario_file(), "--no-map", "--out", path("file")});
  EXPECT_NE(taken.exit_code, 0);
  EXPECT_THAT(taken.err, HasSubstr("file"));
}

TEST_F(CommandLine, PredictCanBeCancelled) {
  RunningProgram predicting({"predict",
                             scenario_file(),
                             "--set",
                             "duration_s=30",
                             "--rate",
                             "10",
                             "--cell-m",
                             "10",
                             "--out",
                             path("cancelled_prediction")},
                            path(""));
  for (int i = 0; i < 200 && predicting.err().find("the flight") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  predicting.signal(SIGINT);
  EXPECT_EQ(predicting.wait(), 3);
  EXPECT_FALSE(fs::exists(path("cancelled_prediction")));
}

}  // namespace
}  // namespace overfly::testing
