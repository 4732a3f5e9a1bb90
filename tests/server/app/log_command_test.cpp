// overfly log: what it prints of a flight log, and the files it writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/motion/trajectory_io.hpp"
#include "core/text/number_text.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class LogCommand : public ::testing::Test {
 protected:
  void SetUp() override { write_text(path("flight.bin"), northward_log()); }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  TemporaryFolder folder_;
};

/// T_world_body: 2 s to the east, banked to the right by 30 deg.
std::string banked_poses() {
  const Eigen::Quaterniond q = R_world_body_from({rad_from_deg(30.0), 0.05, rad_from_deg(90.0)});
  std::string rows;
  for (int i = 0; i <= 4; ++i) {
    rows += number_text(0.5 * i) + " " + number_text(12.5 * i) + " 0 600";
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) rows += " " + number_text(value);
    rows += "\n";
  }
  return rows;
}

/// A scenario that flies poses.tum; with sensors the export states how its camera is mounted.
std::string small_scenario(bool with_sensors) {
  Json scenario = Json::parse(R"({
    "format_version": 1, "seed": 1, "world": {"builtin": {"seed": 1}},
    "flight": {"log": {"file": "poses.tum"}},
    "camera": {"width_px": 64, "height_px": 48, "fov_deg": 80, "rate_hz": 10},
    "renderer": {"camera": "raycast"}})");
  if (with_sensors) {
    scenario["camera"]["mount"] = {{"pitch_deg", 25.0}};
    scenario["sensors"] = {{"gps", Json::object()}};
  }
  return scenario.dump();
}

TEST_F(LogCommand, InfoListsStreamsTruthAndEvents) {
  const Outcome text = overfly_program({"log", "info", path("flight.bin")});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("dataflash, "));
  EXPECT_THAT(text.out, HasSubstr("position, attitude (simulation)"));
  EXPECT_THAT(text.out, HasSubstr("mode 10"));
  EXPECT_THAT(text.out, HasSubstr("truth: SIM: the simulator's own state"));
  const Outcome json = overfly_program({"log", "info", path("flight.bin"), "--json"});
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const Json log = Json::parse(json.out);
  EXPECT_EQ(log.at("format"), "dataflash");
  EXPECT_EQ(log.at("truth").at("attitude"), "SIM");
  EXPECT_EQ(log.at("on_ground"), false);
  const Json& sim = log.at("streams").at(2);
  EXPECT_EQ(sim.at("name"), "SIM");
  EXPECT_EQ(sim.at("messages"), 50);
  EXPECT_NEAR(sim.at("rate_hz").get<double>(), 25.0, 1e-9);
  EXPECT_EQ(log.at("events").at(0).at("kind"), "mode");
  EXPECT_EQ(log.at("clock_runs").size(), 1U);
}

TEST_F(LogCommand, InfoOfASliceCountsItsMessages) {
  const Outcome json =
      overfly_program({"log", "info", path("flight.bin"), "--from", "1.5", "--to", "2", "--json"});
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const Json log = Json::parse(json.out);
  ASSERT_EQ(log.at("streams").size(), 1U);
  const Json& sim = log.at("streams").at(0);
  EXPECT_EQ(sim.at("messages"), 13);
  EXPECT_EQ(sim.at("first_s"), 1.52);
  EXPECT_TRUE(log.at("events").empty());
  const Outcome wrong = overfly_program({"log", "info", path("flight.bin"), "--from", "-1"});
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_THAT(wrong.err, HasSubstr("must be in [0, 9e9] s"));
}

TEST_F(LogCommand, ConvertWritesTumAndCsv) {
  const Outcome tum =
      overfly_program({"log", "convert", path("flight.bin"), "--out", path("flight.tum")});
  ASSERT_EQ(tum.exit_code, 0) << tum.err;
  EXPECT_THAT(tum.out, HasSubstr("50 poses of SIM"));
  const auto poses = read_trajectory(path("flight.tum"));
  ASSERT_TRUE(poses.ok()) << poses.error().message;
  EXPECT_EQ(poses->trajectory.size(), 50U);
  EXPECT_NEAR(poses->trajectory.path_length_m(), 49.0, 0.5);
  const Outcome csv = overfly_program({"log",
                                       "convert",
                                       path("flight.bin"),
                                       "--from",
                                       "1.5",
                                       "--to",
                                       "2.0",
                                       "--geoid-separation-m",
                                       "48",
                                       "--out",
                                       path("flight.csv")});
  ASSERT_EQ(csv.exit_code, 0) << csv.err;
  EXPECT_THAT(read_text(path("flight.csv")),
              HasSubstr("alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg\n1.520000000,47.00011"));
}

TEST_F(LogCommand, RejectsWhatItCannotDo) {
  const auto rejected = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"log", "convert", path("flight.bin")});
    const Outcome outcome = overfly_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(rejected({"--out", path("a.txt")}), HasSubstr("must end with .tum or .csv"));
  EXPECT_THAT(rejected({"--out", path("absent/a.tum")}), HasSubstr("does not exist"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--source", "GPS"}),
              HasSubstr("source GPS: must be one of the sources with positions: SIM"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--from", "nan"}), HasSubstr("--from nan"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--from", "5", "--to", "4"}),
              HasSubstr("must not be after"));
  EXPECT_THAT(rejected({"--out", path("a.csv"), "--geoid-separation-m", "500"}),
              HasSubstr("must be in [-120, 120]"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--geoid-separation-m", "5"}),
              HasSubstr("only used for a .csv file"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--from", "500"}),
              HasSubstr("no valid positions in the time asked for"));
  // A log may be called so, and a link to it may stand in another folder.
  const std::string log = read_text(path("flight.bin"));
  std::filesystem::create_symlink("flight.bin", path("link.csv"));
  EXPECT_THAT(rejected({"--out", path("link.csv")}), HasSubstr("link.csv: is the log itself"));
  EXPECT_EQ(read_text(path("flight.bin")), log);
  write_text(path("text"), "hello");
  const Outcome text = overfly_program({"log", "info", path("text")});
  EXPECT_EQ(text.exit_code, 2);
  EXPECT_THAT(text.err, HasSubstr("is not a flight log"));
}

/// A mapping of a climb to the north at 25 m/s for 20 s with one erratic position.
void write_csv_log(const std::filesystem::path& folder) {
  std::string rows = "t,lat,lon,alt,roll,pitch,yaw\n";
  for (int i = 0; i <= 200; ++i) {
    rows += std::to_string(100 * i) + ',' +
            std::to_string(470000000 + 225 * i + (i == 100 ? 9000 : 0)) + ",80000000," +
            std::to_string(500 + i) + ",0,0,0\n";
  }
  write_text(folder / "rows.csv", rows);
  write_text(folder / "log.json", R"({"csv_mapping_version": 1, "pieces": [
    {"name": "GPS", "file": "rows.csv", "origin": "gps",
     "time": {"column": "t", "unit": "ms", "offset_s": 5},
     "columns": {"lat": {"column": "lat", "unit": "1e-7deg"},
                 "lon": {"column": "lon", "unit": "1e-7deg"},
                 "alt_msl": {"column": "alt", "unit": "m", "scale": 0.1},
                 "roll": {"column": "roll", "unit": "deg"},
                 "pitch": {"column": "pitch", "unit": "deg"},
                 "yaw": {"column": "yaw", "unit": "deg"}}}]})");
}

TEST_F(LogCommand, SmoothWritesPosesResidualsAndAReport) {
  write_csv_log(std::filesystem::path(path("log.json")).parent_path());
  const std::string mapping = path("log.json");
  const Outcome info = overfly_program({"log", "info", mapping, "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(Json::parse(info.out).at("format"), "csv");
  const Outcome text = overfly_program({"log",
                                        "smooth",
                                        mapping,
                                        "--out",
                                        path("smooth.tum"),
                                        "--rate-hz",
                                        "100",
                                        "--residuals",
                                        path("residuals.csv")});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("200 used (0 shifted), 1 left out"));
  EXPECT_THAT(text.out, HasSubstr("1 jump:\n  1 position left out at "));
  EXPECT_THAT(read_text(path("residuals.csv")), HasSubstr(",position,0,0,"));
  const auto poses = read_trajectory(path("smooth.tum"));
  ASSERT_TRUE(poses.ok()) << poses.error().message;
  const Outcome json = overfly_program({"log",
                                        "smooth",
                                        mapping,
                                        "--out",
                                        path("smooth.csv"),
                                        "--geoid-separation-m",
                                        "48",
                                        "--json"});
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const Json report = Json::parse(json.out);
  EXPECT_EQ(report.at("positions").at("left_out"), 1);
  EXPECT_EQ(report.at("jumps").at(0).at("kind"), "position_outliers");
  EXPECT_NEAR(report.at("jumps").at(0).at("size_m").get<double>(), 100.0, 1.0);
  EXPECT_THAT(read_text(path("smooth.csv")), HasSubstr("alt_ellipsoid_m"));
}

TEST_F(LogCommand, SmoothRejectsWhatItCannotDo) {
  write_csv_log(std::filesystem::path(path("log.json")).parent_path());
  const auto rejected = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"log", "smooth", path("log.json")});
    const Outcome outcome = overfly_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--time-offset-s", "soon"}),
              HasSubstr("must be a number or auto"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--time-offset-s", "5"}),
              HasSubstr("time_offset_s = 5: must be in [-2, 2]"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--rate-hz", "0"}),
              HasSubstr("must be in (0, 1000]"));
  EXPECT_THAT(rejected({"--out", path("rows.csv")}), HasSubstr("is the log itself"));
  EXPECT_THAT(rejected({"--out", path("a.tum"), "--residuals", path("rows.csv")}),
              HasSubstr("is the log itself"));
  // One file would be written over the other.
  const std::filesystem::path folder = folder_.path();
  const std::string roundabout = (folder / ".." / folder.filename() / "." / "a.csv").string();
  for (const std::string& same : {path("a.csv"), roundabout}) {
    EXPECT_THAT(rejected({"--out", path("a.csv"), "--residuals", same}),
                HasSubstr("is the file of --out"));
  }
  EXPECT_FALSE(std::filesystem::exists(path("a.csv")));
}

/// What is exported is the camera's pose; a flight is that of the body.
TEST_F(LogCommand, ConvertsAnExportIntoTheFlightOfItsTruth) {
  write_text(path("poses.tum"), banked_poses());
  for (const bool with_sensors : {false, true}) {
    write_text(path("scenario.json"), small_scenario(with_sensors));
    const std::string folder = path(with_sensors ? "with" : "without");
    const Outcome exported = overfly_program(
        {"export", path("scenario.json"), "--format", "mcap", "--out", folder, "--quiet"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;
    const Outcome converted = overfly_program({"log",
                                               "convert",
                                               folder + "/flight.mcap",
                                               "--source",
                                               "/camera/truth",
                                               "--out",
                                               path("back.tum")});
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
    EXPECT_THAT(converted.err, Not(HasSubstr("it is taken to look down")));
    const auto truth = read_trajectory(path("poses.tum"));
    const auto back = read_trajectory(path("back.tum"));
    ASSERT_TRUE(truth.ok() && back.ok());
    ASSERT_GE(back->trajectory.size(), 10U);
    const std::int64_t begin_ns = back->trajectory.begin_ns();
    for (const StampedPose& pose : back->trajectory.poses()) {
      const auto expected = truth->trajectory.at(pose.t_ns - begin_ns);
      ASSERT_TRUE(expected);
      EXPECT_LT(rotation_angle_rad(pose.pose.rotation, expected->rotation), 1e-4);
    }
  }
}

}  // namespace
}  // namespace overfly::testing
