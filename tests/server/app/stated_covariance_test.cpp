// Estimators in processes that state covariances of their poses, from the flight to the scores.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// An odometry with the true poses of an earlier flight, in units of 100 m, and Gaussian noise of
/// 0.3 m and 2 mrad in each axis. Its first pose defines its frame and has no error. It states the
/// covariance of that noise, divided by an argument; or one that is none in every second frame.
constexpr const char* kNoisyOdometry = R"(
import json, math, random, sys
sys.path.insert(0, sys.argv[1])
import overfly_vo

truth = {}
for line in open(sys.argv[2]):
    row = json.loads(line)
    truth[row["frame"]] = row
divisor = float(sys.argv[3])
untidy = sys.argv[4] == "untidy"
noise = random.Random(11)

def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)

class Noisy(overfly_vo.Estimator):
    name = "noisy odometry"
    started = False

    def track(self, frame):
        row = truth[frame.index]
        p = row["T_world_camera"]["p_m"]
        q = row["T_world_camera"]["q_xyzw"]
        answer = overfly_vo.Answer(state=overfly_vo.TRACKING, scene_depth=0.01 * row["axis_depth_m"])
        if self.started:
            p = [value + noise.gauss(0.0, 0.3) for value in p]
            half = [0.5 * noise.gauss(0.0, 0.002) for _ in range(3)]
            q = product((*half, math.sqrt(1.0 - sum(h * h for h in half))), q)
            variances = 3 * [0.003 ** 2 / divisor] + 3 * [0.002 ** 2 / divisor]
            answer.covariance = [[variances[i] if i == k else 0.0 for k in range(6)]
                                 for i in range(6)]
            if untidy and frame.index % 2:
                answer.covariance[1][2] = 1.0
        self.started = True
        answer.position = tuple(0.01 * value for value in p)
        answer.quaternion_xyzw = tuple(q)
        return answer

overfly_vo.run(Noisy())
)";

class StatedCovariance : public CommandLine {
 protected:
  /// Flies the three estimators, after a flight that gives them the truth.
  void fly() {
    write_text(path("noisy.py"), kNoisyOdometry);
    ASSERT_EQ(fly_with(Json::array({{{"name", "perfect"}, {"type", "perfect"}}}), first_).exit_code,
              0);
    flight_ = fly_with(Json::array({noisy("honest", "1", "tidy"),
                                    noisy("boaster", "4", "tidy"),
                                    noisy("untidy", "1", "untidy")}),
                       second_);
    ASSERT_EQ(flight_.exit_code, 0) << flight_.err;
  }

  Json noisy(const std::string& name, const std::string& divisor, const std::string& how) const {
    return {{"name", name},
            {"type", "process"},
            {"command",
             {"python3",
              "-B",
              path("noisy.py"),
              source_file("vo_bridges/client").string(),
              path(first_ + "/frames.jsonl"),
              divisor,
              how}}};
  }

  Outcome fly_with(const Json& estimators, const std::string& folder) const {
    return overfly_program({"run",
                            scenario_file(),
                            "--out",
                            path(folder),
                            "--quiet",
                            "--set",
                            "duration_s=6",
                            "--set",
                            "estimators=" + estimators.dump()});
  }

  [[nodiscard]] Json metrics_of(const std::string& estimator) const {
    return Json::parse(read_text(path(second_ + "/metrics.json"))).at("estimators").at(estimator);
  }

  const std::string first_ = own_name("first");
  const std::string second_ = own_name("second");
  Outcome flight_;

 private:
  /// The tests share a folder.
  static std::string own_name(const std::string& name) {
    return name + "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
  }
};

TEST_F(StatedCovariance, HonestOneIsConsistentAndTheBoasterIsMarked) {
  SKIP_WITHOUT_EGL();
  ASSERT_NO_FATAL_FAILURE(fly());
  EXPECT_EQ(metrics_of("honest").at("covariances"), Json({{"stated", 60}, {"left_out", 0}}));
  for (const char* const mode : {"init_scale", "sim3"}) {
    const Json honest = metrics_of("honest").at("alignments").at(mode);
    const Json& consistency = honest.at("consistency");
    EXPECT_EQ(consistency.at("position").at("honesty"), "consistent") << mode << consistency;
    EXPECT_NEAR(consistency.at("position").at("deviation_ratio").get<double>(), 1.0, 0.12) << mode;
    const Json boaster = metrics_of("boaster").at("alignments").at(mode).at("consistency");
    EXPECT_EQ(boaster.at("honesty"), "overconfident") << mode;
    EXPECT_NEAR(boaster.at("position").at("deviation_ratio").get<double>(), 2.0, 0.24) << mode;
  }
  const Json init_scale = metrics_of("honest").at("alignments").at("init_scale");
  EXPECT_NEAR(init_scale.at("scale").get<double>(), 100.0, 1e-6);
  EXPECT_EQ(init_scale.at("consistency").at("honesty"), "consistent");
  EXPECT_EQ(init_scale.at("consistency").at("pose").at("samples"), 60);
  EXPECT_THAT(flight_.out, HasSubstr("overconfident, errors are "));

  const Outcome scored = overfly_program({"evaluate", "--run", path(second_)});
  EXPECT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_THAT(scored.out, HasSubstr("position NEES "));
  EXPECT_THAT(scored.out, HasSubstr("with a position fix every 1, 2, 5 km: not known, the scored"));
}

TEST_F(StatedCovariance, InvalidOnesAreLeftOutCountedAndNoted) {
  SKIP_WITHOUT_EGL();
  ASSERT_NO_FATAL_FAILURE(fly());
  const Json untidy = metrics_of("untidy");
  EXPECT_EQ(untidy.at("covariances"), Json({{"stated", 30}, {"left_out", 30}}));
  EXPECT_EQ(untidy.at("tracked_frames"), 61) << "the poses are kept";
  EXPECT_EQ(untidy.at("alignments").at("init_scale").at("consistency").at("position").at("samples"),
            30);
  EXPECT_THAT(read_text(path(second_ + "/log.jsonl")),
              HasSubstr("frame 1: covariance: values (3, 2) = "));
  EXPECT_THAT(flight_.out, HasSubstr("30 of 60 stated covariances are invalid and left out"));
  const std::string before = read_text(path(second_ + "/metrics.json"));
  EXPECT_EQ(overfly_program({"evaluate", "--run", path(second_)}).exit_code, 0);
  EXPECT_EQ(read_text(path(second_ + "/metrics.json")), before) << "the rows have the covariances";
}

}  // namespace
}  // namespace overfly::testing
