// overfly scenario, doctor and bench: what they print for people and for programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class ScenarioCommand : public CommandLine {};

TEST_F(ScenarioCommand, WhatIsShownIsAScenarioItself) {
  const Outcome shown = overfly_program({"scenario", "show", scenario_file()});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  write_text(path("shown.json"), shown.out);
  const Outcome valid = overfly_program({"scenario", "validate", path("shown.json")});
  EXPECT_EQ(valid.exit_code, 0) << valid.err;
  EXPECT_EQ(valid.out, path("shown.json") + ": valid\n");
  EXPECT_EQ(overfly_program({"scenario", "show", path("shown.json")}).out, shown.out)
      << "defaults change nothing";
}

TEST_F(ScenarioCommand, ListsOnlyFoldersThatExist) {
  const Outcome outcome = overfly_program({"scenario", "list", path("nowhere")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere: no such folder"));
}

TEST_F(ScenarioCommand, EveryInvalidFileIsNamed) {
  write_text(path("empty.json"), "");
  write_text(path("list.json"), "[]");
  write_text(path("fast.json"),
             R"({"format_version":1,"world":{"builtin":1},
                 "flight":{"course":{"airspeed_m_s":-3}},"estimators":[]})");
  const Outcome outcome = overfly_program({"scenario",
                                           "validate",
                                           path("empty.json"),
                                           scenario_file(),
                                           path("list.json"),
                                           path("fast.json"),
                                           path("none.json")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, scenario_file() + ": valid\n");
  for (const char* name : {"empty.json", "list.json", "fast.json", "none.json"}) {
    EXPECT_THAT(outcome.err, HasSubstr(path(name)));
  }
  EXPECT_THAT(outcome.err, HasSubstr("airspeed_m_s = -3"));
  EXPECT_THAT(outcome.err, Not(HasSubstr(scenario_file())));
}

TEST_F(ScenarioCommand, AFolderIsListedWithWhatCannotBeFlown) {
  fs::create_directories(path("folder"));
  fs::copy_file(scenario_file(), path("folder/good.json"));
  write_text(path("folder/broken.json"), R"({"format_version": 1,)");
  write_text(path("folder/notes.txt"), "no scenario");
  const Outcome listed = overfly_program({"scenario", "list", path("folder")});
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr("good: "));
  EXPECT_THAT(listed.out, HasSubstr("broken: "));
  EXPECT_THAT(listed.out, HasSubstr("  cannot be flown here: "));
  EXPECT_THAT(listed.out, Not(HasSubstr("notes")));
}

TEST_F(ScenarioCommand, EveryScenarioOfTheProgramIsListedOnce) {
  const std::string listed = overfly_program({"scenario", "list"}).out;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(source_file("scenarios"))) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".json" || name.ends_with(".schema")) continue;
    ++files;
    const std::string line = name + ": ";
    const std::size_t found = ("\n" + listed).find("\n" + line);
    EXPECT_NE(found, std::string::npos) << name;
    EXPECT_EQ(("\n" + listed).find("\n" + line, found + 1), std::string::npos) << name;
  }
  EXPECT_GT(files, 3);
}

TEST_F(ScenarioCommand, TheSchemaIsThatOfTheSourceTree) {
  const Json printed = Json::parse(overfly_program({"scenario", "schema"}).out);
  EXPECT_EQ(printed, Json::parse(read_text(source_file("scenarios/scenario.schema.json"))));
}

TEST_F(ScenarioCommand, DoctorsReportForProgramsSaysTheSame) {
  const Outcome text = overfly_program({"doctor", "--runs", path("runs")});
  const Outcome json = overfly_program({"doctor", "--runs", path("runs"), "--json"});
  EXPECT_EQ(json.exit_code, text.exit_code);
  std::set<std::string> levels;
  bool error = false;
  const Json checks = Json::parse(json.out).at("checks");
  for (const Json& check : checks) {
    const std::string name = check.at("name").get<std::string>();
    EXPECT_THAT(text.out, HasSubstr(name));
    const std::string level = check.at("level").get<std::string>();
    levels.insert(level);
    error = error || level == "error";
  }
  for (const std::string& level : levels) {
    EXPECT_THAT((std::set<std::string>{"ok", "warning", "note", "error"}),
                ::testing::Contains(level));
  }
  EXPECT_EQ(json.exit_code == 4, error);
}

TEST_F(ScenarioCommand, BenchRefusesWhatItCannotMeasure) {
  EXPECT_EQ(overfly_program({"bench", "--repetitions", "0"}).exit_code, 2);
  EXPECT_EQ(overfly_program({"bench", "--flight-s", "-1"}).exit_code, 2);
  const Outcome camera = overfly_program({"bench", "--fly-km", "2", "--fly-camera", "eye"});
  EXPECT_EQ(camera.exit_code, 2);
  EXPECT_THAT(camera.err, HasSubstr("eye"));
  const Outcome length = overfly_program({"bench", "--fly-km", "1"});
  EXPECT_EQ(length.exit_code, 2);
  EXPECT_THAT(length.err, HasSubstr("--fly-km: Value 1 not in range 1.5"));
}

}  // namespace
}  // namespace overfly::testing
