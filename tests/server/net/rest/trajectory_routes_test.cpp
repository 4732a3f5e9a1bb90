// Trajectories over REST: their list, names, uploads, series, and scores that equal the
// evaluation's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/motion/trajectory_io.hpp"
#include "core/time.hpp"
#include "evaluation/axis_errors.hpp"
#include "evaluation/evaluation.hpp"
#include "server/record/run_lock.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kTrajectories = "/api/v1/trajectories";

/// A weaving climb at 20 Hz with one kick, as TUM text. @param scale, drift  of an estimate
std::string weaving_tum(double scale, double drift, int poses = 800) {
  std::string text = "# made for a test\n";
  for (int i = 0; i < poses; ++i) {
    const double t = 0.05 * i;
    const double kick = i == 401 && drift != 0.0 ? 3.0 : 0.0;
    const double yaw = 0.3 * std::sin(0.4 * t) + drift * 0.001 * t;
    char line[300];
    std::snprintf(line,
                  sizeof line,
                  "%.3f %.9f %.9f %.9f 0 0 %.12f %.12f\n",
                  1000.0 + t,
                  scale * (25.0 * t + drift * t + kick),
                  scale * (40.0 * std::sin(0.4 * t) + drift * std::cos(t)),
                  scale * (0.5 * t + drift * 0.1 * t),
                  std::sin(yaw / 2),
                  std::cos(yaw / 2));
    text += line;
  }
  return text;
}

net::ServerLimits few_bytes() {
  net::ServerLimits limits;
  limits.uploads.max_bytes = std::uint64_t{1} << 20U;
  limits.uploads.quota_bytes = std::uint64_t{2} << 20U;
  return limits;
}

class TrajectoryRoutesTest : public ::testing::Test {
 protected:
  Answer call(const std::string& method, const std::string& target, const std::string& body = "") {
    return ask(server_.port(), method, target, body);
  }
  Answer evaluate(const json& request) {
    return ask(server_.port(), "POST", "/api/v1/evaluations", request.dump(), kJson);
  }
  fs::path data(const std::string& name) { return server_.folder() / "logs" / name; }

  TestServer server_{few_bytes()};
};

TEST_F(TrajectoryRoutesTest, ListsTrajectoriesByTheirFirstPose) {
  fs::create_directories(data("deep/.hidden"));
  write_text(data("deep/flight.tum"), weaving_tum(1.0, 0.0));
  write_text(data("deep/.hidden/a.tum"), weaving_tum(1.0, 0.0));
  write_text(data("poses.txt"), "1 0 0 0 0 1 0 0 0 0 1 0\n");
  write_text(data("truth.csv"), "#t,x,y,z,w,x,y,z\n1000,1,2,3,1,0,0,0,9,9\n");
  write_text(data("notes.txt"), "these are notes\n");
  write_text(data("imu.csv"), "1000,1,2,3,1,0,0\n");
  write_text(data("quaternion.txt"), "0 1 2 3 1 1 1 1\n");
  write_text(data("empty.txt"), "");
  write_text(data("line.txt"), std::string(100'000, '1'));
  write_text(data("flight.bin"), northward_log());
  ASSERT_EQ(::mkfifo(data("fifo.txt").c_str(), 0600), 0);
  const json list = call("GET", kTrajectories).json();
  ASSERT_EQ(list.at("trajectories").size(), 3U) << list;
  const json& first = list.at("trajectories").at(0);
  EXPECT_EQ(first.at("name"), "file:logs/deep/flight.tum");
  EXPECT_EQ(first.at("folder"), "logs/deep");
  EXPECT_EQ(first.at("format"), "tum");
  EXPECT_EQ(first.at("uploaded"), false);
  EXPECT_EQ(list.at("trajectories").at(1).at("format"), "kitti");
  EXPECT_EQ(list.at("trajectories").at(2).at("format"), "euroc");
  EXPECT_EQ(list.at("complete"), true);
}

TEST_F(TrajectoryRoutesTest, SaysTheSameOfEveryOtherName) {
  write_text(server_.folder() / "secret.tum", weaving_tum(1.0, 0.0));
  fs::create_symlink(server_.folder() / "secret.tum", data("link.tum"));
  fs::create_directory_symlink(server_.folder(), data("door"));
  ASSERT_EQ(::mkfifo(data("fifo.tum").c_str(), 0600), 0);
  EXPECT_TRUE(call("GET", kTrajectories).json().at("trajectories").empty());
  for (const std::string name : {"file:logs/link.tum",
                                 "file:logs/door/secret.tum",
                                 "file:logs/../secret.tum",
                                 "file:logs//etc/a.txt",
                                 "file:logs/fifo.tum",
                                 "file:logs/none.tum",
                                 "file:/etc/passwd",
                                 "file:",
                                 "log:logs/none.bin",
                                 "log:logs/link.tum?GPS",
                                 "run:none/truth",
                                 "run:../logs/truth",
                                 "run:none",
                                 "logs/link.tum",
                                 "x:y"}) {
    std::string encoded;
    for (const char c : name) {
      encoded += c == '/' ? "%2F" : c == '?' ? "%3F" : std::string(1, c);
    }
    const Answer series = call("GET", std::string(kTrajectories) + "/" + encoded + "/series");
    EXPECT_EQ(series.status, 404) << name << series.body;
    EXPECT_THAT(series.body, HasSubstr("no such trajectory")) << name;
    EXPECT_EQ(evaluate({{"truth", name}, {"estimates", {name}}}).status, 404) << name;
  }
  EXPECT_TRUE(fs::exists(server_.folder() / "secret.tum"));
  EXPECT_EQ(call("DELETE", std::string(kTrajectories) + "/file:logs%2Flink.tum").status, 404);
}

TEST_F(TrajectoryRoutesTest, TakesUploadsThatAreTrajectories) {
  const std::string post = std::string(kTrajectories) + "?name=";
  const Answer taken = call("POST", post + "a.tum", weaving_tum(1.0, 0.0));
  ASSERT_EQ(taken.status, 201) << taken.body;
  EXPECT_EQ(taken.json().at("name"), "file:uploads/a.tum");
  EXPECT_EQ(taken.headers.at("location"), "/api/v1/trajectories/file:uploads%2Fa.tum");
  EXPECT_EQ(call("POST", post + "a.tum", weaving_tum(1.0, 0.0)).status, 409);
  EXPECT_EQ(call("GET", kTrajectories).json().at("trajectories").at(0), taken.json());
  const Answer broken =
      call("POST", post + "b.tum", weaving_tum(1.0, 0.0) + "1 2 three 4 0 0 0 1\n");
  EXPECT_EQ(broken.status, 422);
  const std::string message = broken.json().at("error").at("message");
  EXPECT_THAT(message, ::testing::StartsWith("b.tum:802: column 3 = 'three'"));
  EXPECT_EQ(call("POST", post + "c.tum", "").status, 422);
  EXPECT_EQ(call("POST", post + "c.tum", std::string(100'000, ',')).status, 422);
  EXPECT_EQ(call("POST", post + "..%2Fc.tum", weaving_tum(1.0, 0.0)).status, 400);
  EXPECT_EQ(call("POST", post + "c.bin", weaving_tum(1.0, 0.0)).status, 400);
  // It would be taken for the times of every KITTI file in the folder of uploads.
  for (const char* name : {"times.txt", "Times.TXT"}) {
    const Answer times = call("POST", post + name, weaving_tum(1.0, 0.0));
    EXPECT_EQ(times.status, 400) << name;
    EXPECT_THAT(times.body, HasSubstr("not be times.txt"));
  }
  EXPECT_EQ(call("POST", post + "c.tum", std::string((1U << 20U) + 1U, ' ')).status, 413);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(server_.folder() / "uploads")) {
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(files, 1U);
  write_text(data("kept.tum"), weaving_tum(1.0, 0.0));
  const std::string one = std::string(kTrajectories) + "/file:";
  EXPECT_EQ(call("DELETE", one + "logs%2Fkept.tum").status, 403);
  EXPECT_EQ(call("DELETE", one + "uploads%2Fa.tum").status, 204);
  EXPECT_EQ(call("DELETE", one + "uploads%2Fa.tum").status, 404);
  EXPECT_EQ(call("DELETE", std::string(kTrajectories) + "/run:x%2Ftruth").status, 403);
}

TEST_F(TrajectoryRoutesTest, SeriesKeepTheExtremes) {
  write_text(data("a.tum"), weaving_tum(1.0, 1.0, 20'000));
  const std::string series = std::string(kTrajectories) + "/file:logs%2Fa.tum/series";
  const json answer = call("GET", series + "?points=100").json();
  EXPECT_EQ(answer.at("poses"), 20'000);
  const json& positions = answer.at("positions");
  EXPECT_LE(positions.at("t_s").size(), 100U);
  EXPECT_GE(positions.at("t_s").size(), 20U);
  EXPECT_EQ(positions.at("t_s").front(), s_from_ns(1'000'000'000'000));
  const auto file = read_trajectory(data("a.tum"));
  double highest = 0.0;
  for (const StampedPose& pose : file->trajectory.poses()) {
    highest = std::max(highest, pose.pose.translation.y());
  }
  double kept = 0.0;
  for (const json& value : positions.at("y_m")) kept = std::max(kept, value.get<double>());
  EXPECT_EQ(kept, highest);
  EXPECT_EQ(call("GET", series + "?points=99").status, 400);
  EXPECT_EQ(call("GET", series + "?point=100").status, 400);
}

TEST_F(TrajectoryRoutesTest, ScoresEqualThoseOfTheEvaluation) {
  write_text(data("truth.tum"), weaving_tum(1.0, 0.0));
  write_text(data("estimate.tum"), weaving_tum(0.3, 0.7));
  const auto truth = read_trajectory(data("truth.tum"));
  const auto estimate = read_trajectory(data("estimate.tum"));
  EstimateTrack track;
  for (const StampedPose& pose : estimate->trajectory.poses()) {
    EstimateSample sample;
    sample.frame = static_cast<std::int64_t>(track.samples.size());
    sample.t_ns = pose.t_ns;
    sample.state = TrackingState::kTracking;
    sample.T_vo_camera = pose.pose;
    track.samples.push_back(sample);
  }
  const evaluation::Options options;
  const evaluation::Score score = evaluation::score(truth->trajectory, track, options);
  const auto matches = evaluation::associate(truth->trajectory, track, options);
  const Answer answer = evaluate({{"truth", "file:logs/truth.tum"},
                                  {"estimates", {"file:logs/estimate.tum", "file:logs/none.tum"}},
                                  {"alignments", {"sim3", "init_scale", "se3"}},
                                  {"points", 5000}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json scored = answer.json();
  const json& entry = scored.at("estimates").at(0);
  EXPECT_EQ(scored.at("estimates").at(1).at("error").at("code"), "not_found");
  ASSERT_EQ(entry.at("alignments").size(), 3U);
  EXPECT_EQ(entry.at("matched"), 800);
  EXPECT_EQ(entry.at("run_outcome"), nullptr);
  for (const char* name : {"sim3", "init_scale", "se3"}) {
    const auto& expected = score.alignments.at(*evaluation::alignment_mode_from(name));
    const json& found = entry.at("alignments").at(name);
    EXPECT_NEAR(found.at("scale").get<double>(), expected.S_world_vo.scale, 1e-12);
    EXPECT_NEAR(found.at("position_rmse_m").get<double>(), expected.position_m.rmse, 1e-12);
    EXPECT_NEAR(found.at("rotation_rmse_deg").get<double>(), expected.rotation_deg->rmse, 1e-12);
    const auto axes = evaluation::axis_errors(
        truth->trajectory, *matches, expected.S_world_vo, options.T_body_camera);
    const double horizontal_m = found.at("horizontal_rmse_m").get<double>();
    EXPECT_NEAR(horizontal_m, evaluation::rmse_of(axes).horizontal_m, 1e-12);
    EXPECT_NEAR(std::hypot(horizontal_m, found.at("vertical_rmse_m").get<double>()),
                expected.position_m.rmse,
                1e-9);
    EXPECT_NEAR(found.at("percent_of_path").get<double>(),
                100.0 * expected.position_m.rmse / truth->trajectory.path_length_m(),
                1e-9);
    // Every row of the tables is the error of a match.
    const json& errors = entry.at("series").at(name).at("errors");
    ASSERT_EQ(errors.at("t_s").size(), 800U);
    for (std::size_t i = 0; i < 800; i += 37) {
      EXPECT_EQ(errors.at("t_s").at(i), s_from_ns(score.matched_t_ns[i]));
      EXPECT_EQ(errors.at("position_m").at(i), expected.position_errors_m[i]);
      EXPECT_EQ(errors.at("rotation_deg").at(i), expected.rotation_errors_deg[i]);
      const json& by_axis = entry.at("series").at(name).at("axis_errors");
      EXPECT_EQ(by_axis.at("along_m").at(i), axes[i].along_m);
    }
    // The scale over the last 100 m, wherever the truth was so far away before.
    const json& scale = entry.at("series").at(name).at("scale");
    std::size_t row = 0;
    for (std::size_t i = 0; i < 800; ++i) {
      const auto apart = [&](std::size_t j) {
        const Eigen::Vector3d way =
            (*matches)[i].T_world_camera.translation - (*matches)[j].T_world_camera.translation;
        return way.norm();
      };
      std::size_t then = i;
      while (then > 0 && apart(then) < 100.0) --then;
      if (apart(then) < 100.0) continue;
      const Eigen::Vector3d way =
          (*matches)[i].T_vo_camera.translation - (*matches)[then].T_vo_camera.translation;
      const double expected_percent =
          100.0 * (expected.S_world_vo.scale * way.norm() / apart(then) - 1.0);
      ASSERT_LT(row, scale.at("t_s").size());
      EXPECT_EQ(scale.at("t_s").at(row), s_from_ns(score.matched_t_ns[i]));
      EXPECT_NEAR(scale.at("scale_percent").at(row).get<double>(), expected_percent, 1e-6);
      ++row;
    }
    EXPECT_EQ(scale.at("t_s").size(), row);
    EXPECT_GT(row, 100U);
  }
}

TEST_F(TrajectoryRoutesTest, RefusesEvaluationsBeyondTheLimits) {
  write_text(data("a.tum"), weaving_tum(1.0, 0.0));
  const std::string a = "file:logs/a.tum";
  const auto message_of = [&](const json& request) {
    const Answer answer = evaluate(request);
    EXPECT_EQ(answer.status, 400) << answer.body;
    return answer.json().at("error").at("message").get<std::string>();
  };
  EXPECT_THAT(message_of({{"truth", a}}), HasSubstr("estimates"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", json::array()}}), HasSubstr("1 to 32"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", json::array({1})}}), HasSubstr("1 to 32"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", std::vector<std::string>(33, a)}}),
              HasSubstr("1 to 32"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", {a}}, {"alignments", {"sim4"}}}),
              HasSubstr("alignments"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", {a}}, {"association", "guess"}}),
              HasSubstr("association"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", {a}}, {"points", 1}}), HasSubstr("points"));
  EXPECT_THAT(message_of({{"truth", a}, {"estimates", {a}}, {"unknown", 1}}), HasSubstr("unknown"));
  EXPECT_THAT(message_of({{"truth", a},
                          {"estimates", std::vector<std::string>(32, a)},
                          {"alignments", {"all"}},
                          {"points", 30'000}}),
              HasSubstr("at most 100000"));
}

TEST_F(TrajectoryRoutesTest, ReadsLogsAndRunsAsWell) {
  write_text(data("a.bin"), northward_log());
  const std::string id = server_.fly("tiny");
  const Answer of_run = evaluate({{"truth", "run:" + id + "/truth"},
                                  {"estimates", {"run:" + id + "/perfect", "log:logs/a.bin"}},
                                  {"alignments", {"sim3"}}});
  ASSERT_EQ(of_run.status, 200) << of_run.body;
  const json perfect = of_run.json().at("estimates").at(0);
  EXPECT_EQ(perfect.at("run_outcome").at("outcome"), "COMPLETED");
  const json metrics = call("GET", "/api/v1/runs/" + id + "/metrics").json();
  const json& own = metrics.at("estimators").at("perfect").at("alignments").at("sim3");
  for (const char* name : {"position_rmse_m", "position_max_m", "scale"}) {
    EXPECT_NEAR(perfect.at("alignments").at("sim3").at(name).get<double>(),
                own.at(name).get<double>(),
                1e-9)
        << name;
  }
  const json series = call("GET", std::string(kTrajectories) + "/log:logs%2Fa.bin/series").json();
  EXPECT_EQ(series.at("kind"), "log");
  EXPECT_GT(series.at("poses").get<int>(), 10);
  EXPECT_NEAR(series.at("attitudes").at("roll_deg").at(3).get<double>(), 10.0, 0.1);
  // The truth's attitude is the aircraft's, through the camera's mount.
  const json truth =
      call("GET", std::string(kTrajectories) + "/run:" + id + "%2Ftruth/series").json();
  const json rows = call("GET", "/api/v1/runs/" + id + "/trajectories/truth?format=json").json();
  EXPECT_NEAR(truth.at("attitudes").at("yaw_deg").at(0).get<double>(),
              rows.at("yaw_deg").at(0).get<double>(),
              1e-3);
}

/// Its files were to be written at its end.
TEST_F(TrajectoryRoutesTest, OfAnInterruptedRunAreMadeFromItsRows) {
  const std::string id = server_.fly("tiny");
  const fs::path killed = server_.folder() / "runs" / "killed";
  fs::copy(server_.folder() / "runs" / id, killed, fs::copy_options::recursive);
  const std::string manifest = read_text(killed / "manifest.json");
  write_text(killed / "manifest.json",
             std::string(manifest).replace(manifest.find("completed"), 9, "running"));
  for (const char* name : {"truth", "perfect"}) {
    const std::string part = std::string("/trajectories/") + name;
    fs::remove(killed / (name == std::string("truth") ? "truth.tum" : "estimates/perfect.tum"));
    const Answer made = call("GET", "/api/v1/runs/killed" + part);
    EXPECT_EQ(made.status, 200) << made.body;
    EXPECT_EQ(made.body, call("GET", "/api/v1/runs/" + id + part).body) << "as at its end";
  }
  const Answer scored = evaluate({{"truth", "run:killed/truth"},
                                  {"estimates", {"run:killed/perfect", "run:killed/nobody"}},
                                  {"alignments", {"sim3"}}});
  ASSERT_EQ(scored.status, 200) << scored.body;
  EXPECT_TRUE(scored.json().at("estimates").at(0).contains("alignments"));
  EXPECT_EQ(scored.json().at("estimates").at(1).at("error").at("code"), "not_found");
  // While it flies there are none.
  const server::RunLock lock = std::move(server::RunLock::take(killed)).value();
  EXPECT_EQ(evaluate({{"truth", "run:killed/truth"}, {"estimates", {"run:killed/perfect"}}}).status,
            404);
}

}  // namespace
}  // namespace overfly::testing
