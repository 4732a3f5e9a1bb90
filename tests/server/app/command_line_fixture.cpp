#include "tests/server/app/command_line_fixture.hpp"

#include <nlohmann/json.hpp>

#include "tests/server/app/program.hpp"

namespace overfly::testing {

void CommandLine::SetUpTestSuite() {
  folder_ = new TemporaryFolder();
  const Outcome made = overfly_program({"world",
                                        "synthesize",
                                        "--out",
                                        world(),
                                        "--size-m",
                                        "600",
                                        "--texel-m",
                                        "2",
                                        "--seed",
                                        "3"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json doctor = nlohmann::json::parse(overfly_program({"doctor", "--json"}).out);
  draws_ = doctor.at("checks").at(0).at("level") == "ok";
  const nlohmann::json scenario = {
      {"format_version", 1},
      {"world", {{"manifest", world() + "/world.json"}}},
      {"flight", {{"course", {{"length_m", 800}, {"leg_length_m", 300}}}}},
      {"duration_s", 1},
      {"camera", {{"width_px", 160}, {"height_px", 120}, {"rate_hz", 10}}},
      {"estimators", {{{"name", "perfect"}, {"type", "perfect"}}}}};
  write_text(scenario_file(), scenario.dump());
}

void CommandLine::TearDownTestSuite() {
  delete folder_;
  folder_ = nullptr;
}

TemporaryFolder* CommandLine::folder_ = nullptr;
bool CommandLine::draws_ = false;

}  // namespace overfly::testing
