// overfly evaluate of trajectory files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(CommandLine, EvaluateScoresTrajectoryFilesAndRejectsInvalidOnes) {
  std::string truth;
  std::string estimate;
  for (int i = 0; i < 20; ++i) {
    const std::string t = std::to_string(i);
    const std::string y = std::to_string(i % 5);
    truth += t + " " + t + " " + y + " 0 0 0 0 1\n";
    estimate +=
        t + " " + std::to_string(2 * i) + " " + std::to_string(2 * (i % 5)) + " 0 0 0 0 1\n";
  }
  write_text(path("truth.tum"), truth);
  write_text(path("estimate.tum"), estimate);
  const Outcome scored = overfly_program({"evaluate",
                                          "--truth",
                                          path("truth.tum"),
                                          "--estimate",
                                          path("estimate.tum"),
                                          "--alignment",
                                          "sim3",
                                          "--alignment",
                                          "none",
                                          "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json alignments = Json::parse(scored.out).at("estimates").at(0).at("alignments");
  EXPECT_NEAR(alignments.at("sim3").at("scale").get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(alignments.at("sim3").at("position_rmse_m").get<double>(), 0.0, 1e-6);
  EXPECT_GT(alignments.at("none").at("position_rmse_m").get<double>(), 1.0);
  EXPECT_THAT(overfly_program({"evaluate",
                               "--truth",
                               path("truth.tum"),
                               "--estimate",
                               path("estimate.tum"),
                               "--alignment",
                               "all"})
                  .out,
              HasSubstr("sim3"));

  EXPECT_EQ(overfly_program({"evaluate", "--truth", path("truth.tum")}).exit_code, 2);
  EXPECT_EQ(overfly_program({"evaluate",
                             "--truth",
                             path("truth.tum"),
                             "--estimate",
                             path("estimate.tum"),
                             "--alignment",
                             "sim4"})
                .exit_code,
            2);
  write_text(path("broken.tum"), "0 1 2 three 0 0 0 1\n");
  const Outcome broken =
      overfly_program({"evaluate", "--truth", path("truth.tum"), "--estimate", path("broken.tum")});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(broken.err, HasSubstr("broken.tum"));
}

/// KITTI's poses without times.txt: nothing may be concluded from seconds.
TEST_F(CommandLine, EvaluateConcludesNothingFromTimesThatAFileDoesNotHave) {
  std::string truth;
  std::string estimate;
  for (int i = 0; i < 120; ++i) {
    const auto line = [](double x) { return "1 0 0 " + std::to_string(x) + " 0 1 0 0 0 0 1 0\n"; };
    truth += line(0.3 * i);
    // The scale grows threefold: over 10 s that would be a divergence.
    estimate += line(0.3 * i * (1.0 + i / 60.0));
  }
  write_text(path("truth.txt"), truth);
  write_text(path("estimate.txt"), estimate);
  const Outcome scored = overfly_program(
      {"evaluate", "--truth", path("truth.txt"), "--estimate", path("estimate.txt"), "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json score = Json::parse(scored.out).at("estimates").at(0);
  EXPECT_TRUE(score.at("diverged_at_s").is_null());
  const Json& aligned = score.at("alignments").at("init_scale");
  EXPECT_THAT(aligned.at("notes").dump(), HasSubstr("the first 50 steps"));
  // Steps of 0.3 m give the direction of the path: east, not that of the camera's nose.
  EXPECT_GT(aligned.at("along_rmse_m"), 1.0);
  EXPECT_LT(aligned.at("across_rmse_m"), 1e-6);
  // What belongs to files is refused for a run instead of being ignored.
  const Outcome mixed =
      overfly_program({"evaluate", "--run", path("r"), "--init-true-depth-m", "300"});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.err, HasSubstr("--init-true-depth-m"));
}

TEST_F(CommandLine, EvaluateTellsTheDriftBetweenPositionFixes) {
  std::string truth;
  std::string estimate;
  for (int i = 0; i <= 150; ++i) {  // 3 km, one percent too long
    const std::string t = std::to_string(i);
    truth += t + " " + std::to_string(20.0 * i) + " 0 300 0 0 0 1\n";
    estimate += t + " " + std::to_string(20.2 * i) + " 0 300 0 0 0 1\n";
  }
  write_text(path("long_truth.tum"), truth);
  write_text(path("long_estimate.tum"), estimate);
  const std::vector<std::string> command = {"evaluate",
                                            "--truth",
                                            path("long_truth.tum"),
                                            "--estimate",
                                            path("long_estimate.tum"),
                                            "--alignment",
                                            "origin"};
  const Outcome scored = overfly_program(command);
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_THAT(scored.out,
              HasSubstr("with a position fix every 1 km: off by 10.000 m (median), 10.000 m "
                        "(worst of 10)"));
  EXPECT_THAT(scored.out, HasSubstr("with a position fix every 2 km: off by 20.000 m (median)"));
  EXPECT_THAT(scored.out,
              HasSubstr("with a position fix every 5 km: not known, the scored path is 3000 m"));
  std::vector<std::string> as_json = command;
  as_json.emplace_back("--json");
  const Json origin =
      Json::parse(overfly_program(as_json).out).at("estimates").at(0).at("alignments").at("origin");
  EXPECT_NEAR(origin.at("fix_drift").at(0).at("worst_m").get<double>(), 10.0, 1e-9);
  EXPECT_EQ(origin.at("fix_drift").at(2).at("unavailable"), "the scored path is 3000 m long");
}

TEST_F(CommandLine, EvaluateReportsErrorsByAxisAndTheOffsetOfAClock) {
  const auto weaving = [](double late_s, double up_m) {
    std::string text;
    for (int i = 0; i < 400; ++i) {
      const double t = 0.1 * i;
      text += std::to_string(t - late_s) + " " + std::to_string(20.0 * t) + " " +
              std::to_string(30.0 * std::sin(0.5 * t)) + " " +
              std::to_string(5.0 * std::sin(0.3 * t) + up_m) + " 0 0 0 1\n";
    }
    return text;
  };
  write_text(path("truth.tum"), weaving(0.0, 0.0));
  write_text(path("high.tum"), weaving(0.0, 2.0));
  write_text(path("late.tum"), weaving(0.7, 0.0));
  const auto estimate_of = [&](const std::string& file) {
    const Outcome scored = overfly_program({"evaluate",
                                            "--truth",
                                            path("truth.tum"),
                                            "--estimate",
                                            path(file),
                                            "--alignment",
                                            "none",
                                            "--find-offsets",
                                            "--json"});
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return Json::parse(scored.out).at("estimates").at(0);
  };
  const Json high = estimate_of("high.tum");
  const Json& none = high.at("alignments").at("none");
  EXPECT_NEAR(none.at("vertical_rmse_m").get<double>(), 2.0, 1e-5);
  EXPECT_NEAR(none.at("horizontal_rmse_m").get<double>(), 0.0, 1e-5);
  EXPECT_NEAR(none.at("percent_of_path").get<double>(),
              200.0 / high.at("truth_path_m").get<double>(),
              1e-4);
  EXPECT_EQ(high.at("offsets").at("clock"), nullptr);
  const Json late = estimate_of("late.tum");
  EXPECT_NEAR(late.at("offsets").at("clock").at("time_offset_s").get<double>(), 0.7, 0.001);
  EXPECT_GT(late.at("alignments").at("none").at("horizontal_rmse_m").get<double>(), 10.0);

  // For people without a sign.
  write_text(path("delayed.tum"), weaving(-0.7, 0.0));
  const auto shown = [&](const std::string& file) {
    return overfly_program({"evaluate",
                            "--truth",
                            path("truth.tum"),
                            "--estimate",
                            path(file),
                            "--find-offsets"})
        .out;
  };
  EXPECT_THAT(shown("late.tum"), ContainsRegex("times are 0\\.[67][0-9]* s early; this explains"));
  EXPECT_THAT(shown("delayed.tum"),
              ContainsRegex("times are 0\\.[67][0-9]* s late; this explains"));
}

std::string wavy_line(int i) {
  const double t_s = 0.1 * i;
  return std::to_string(t_s) + " " + std::to_string(20.0 * t_s) + " " +
         std::to_string(30.0 * std::sin(0.5 * t_s)) + " " + std::to_string(5.0 * std::cos(t_s)) +
         " 0 0 0 1\n";
}

std::string wavy_lines(int count) {
  std::string lines;
  for (int i = 0; i < count; ++i) lines += wavy_line(i);
  return lines;
}

TEST_F(CommandLine, EvaluateDoesNotInterpolateOverAHoleInTheTruth) {
  std::string truth;
  for (int i = 0; i < 300; ++i) {
    if (i <= 100 || i >= 150) truth += wavy_line(i);
  }
  write_text(path("hole.tum"), truth);
  write_text(path("whole.tum"), wavy_lines(300));
  write_text(path("in_hole.tum"), wavy_line(110) + wavy_line(111) + wavy_line(112));
  const auto evaluate = [&](const std::string& estimate) {
    return overfly_program({"evaluate",
                            "--truth",
                            path("hole.tum"),
                            "--estimate",
                            path(estimate),
                            "--alignment",
                            "sim3",
                            "--json"});
  };
  const Outcome scored = evaluate("whole.tum");
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json entry = Json::parse(scored.out).at("estimates").at(0);
  const std::string words = "its steps of more than 1.000 s are gaps (1, the longest 5.000 s)";
  const std::string warning =
      "49 poses of " + path("whole.tum") + " have no truth in " + path("hole.tum") + ": " + words;
  EXPECT_EQ(entry.at("warnings"), Json::array({warning}));
  EXPECT_THAT(scored.err, HasSubstr("warning: " + warning));
  EXPECT_EQ(entry.at("matched"), 251);
  EXPECT_LT(entry.at("alignments").at("sim3").at("position_rmse_m"), 1e-4);
  EXPECT_THAT(entry.at("alignments").at("sim3").at("notes").dump(),
              HasSubstr("49 tracked frames have no truth"));
  // The straight line over the hole belongs to the path.
  EXPECT_GT(entry.at("truth_path_m"), 20.0 * 29.9);
  const Outcome nothing = evaluate("in_hole.tum");
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("of the truth, " + words));
}

TEST_F(CommandLine, EvaluateMatchesByNumberOnlyWhatHasTheSameNumber) {
  std::string kitti;
  for (int i = 0; i < 60; ++i) {
    kitti += "1 0 0 " + std::to_string(2.0 * i) + " 0 1 0 0 0 0 1 0\n";
  }
  write_text(path("kitti.txt"), kitti);
  write_text(path("same.tum"), wavy_lines(60));
  write_text(path("fewer.tum"), wavy_lines(57));
  const auto evaluate = [&](const std::string& estimate, const std::string& association) {
    return overfly_program({"evaluate",
                            "--truth",
                            path("kitti.txt"),
                            "--estimate",
                            path(estimate),
                            "--association",
                            association,
                            "--json"});
  };
  for (const char* association : {"interpolate", "nearest"}) {
    const Outcome refused = evaluate("fewer.tum", association);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err,
                HasSubstr("kitti.txt (60 poses) and " + path("fewer.tum") + " (57 poses): cannot"));
    EXPECT_THAT(refused.err, HasSubstr(path("kitti.txt") + " has none; add times, or use"));
    EXPECT_THAT(refused.err, HasSubstr("--association index"));
  }
  const auto used = [&](const Outcome& scored) {
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return Json::parse(scored.out).at("estimates").at(0).at("association");
  };
  EXPECT_EQ(used(evaluate("fewer.tum", "index")), "index");
  EXPECT_EQ(used(evaluate("same.tum", "interpolate")), "index");
}

TEST_F(CommandLine, EvaluateWarnsThatPosesOfEurocFilesAreOfTheBody) {
  std::string euroc;
  for (int i = 0; i < 60; ++i) {
    euroc += std::to_string(i * 100'000'000LL) + "," + std::to_string(2 * i) + "," +
             std::to_string(i % 7) + ",0,1,0,0,0\n";
  }
  write_text(path("data.csv"), euroc);
  write_text(path("camera.tum"), wavy_lines(60));
  const auto evaluate = [&](const std::string& estimate) {
    return overfly_program(
        {"evaluate", "--truth", path("data.csv"), "--estimate", path(estimate), "--json"});
  };
  const Outcome other = evaluate("camera.tum");
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_THAT(other.err,
              HasSubstr("data.csv: files of the EuRoC format have the poses of the body"));
  EXPECT_THAT(other.err, HasSubstr(path("camera.tum") + " must be of the body too"));
  EXPECT_THAT(other.err, HasSubstr("overfly track converts them"));
  EXPECT_EQ(Json::parse(other.out).at("estimates").at(0).at("warnings").size(), 1U);
  EXPECT_EQ(evaluate("data.csv").err, "");
}

TEST_F(CommandLine, EvaluateScoresTheOtherFilesAfterABadOne) {
  write_text(path("wavy.tum"), wavy_lines(60));
  write_text(path("bad.tum"), "0 1 2 three 0 0 0 1\n");
  std::vector<std::string> command = {"evaluate",
                                      "--truth",
                                      path("wavy.tum"),
                                      "--estimate",
                                      path("bad.tum"),
                                      path("none.tum"),
                                      path("wavy.tum")};
  const Outcome shown = overfly_program(command);
  EXPECT_EQ(shown.exit_code, 2);
  EXPECT_THAT(shown.err, HasSubstr("error: " + path("bad.tum")));
  EXPECT_THAT(shown.err, HasSubstr("none.tum"));
  EXPECT_THAT(shown.out, HasSubstr(path("wavy.tum") + "\n"));
  command.emplace_back("--json");
  const Outcome scored = overfly_program(command);
  EXPECT_EQ(scored.exit_code, 2);
  const Json estimates = Json::parse(scored.out).at("estimates");
  ASSERT_EQ(estimates.size(), 3U);
  EXPECT_EQ(estimates.at(0).at("file"), path("bad.tum"));
  EXPECT_THAT(estimates.at(0).at("error").at("message").get<std::string>(), HasSubstr("three"));
  EXPECT_FALSE(estimates.at(0).contains("alignments"));
  EXPECT_EQ(estimates.at(2).at("file"), path("wavy.tum"));
  EXPECT_EQ(estimates.at(2).at("matched"), 60);
}

/// Trajectory files of other programs may repeat time stamps and be out of order.
TEST_F(CommandLine, EvaluateSortsPosesByTimeAndReportsIt) {
  const auto pose = [](int i, int x) {
    return std::to_string(i) + " " + std::to_string(x) + " " + std::to_string(i % 5) +
           " 0 0 0 0 1\n";
  };
  std::string truth;
  std::string estimate;
  for (int i = 0; i < 20; ++i) {
    truth += pose(i, i);
    if (i == 7) truth += pose(i, 900);  // the second pose of a time is ignored
    estimate += pose(19 - i, 19 - i);
  }
  write_text(path("repeated.tum"), truth);
  write_text(path("backwards.tum"), estimate);
  const auto evaluate = [&](const std::string& association) {
    return overfly_program({"evaluate",
                            "--truth",
                            path("repeated.tum"),
                            "--estimate",
                            path("backwards.tum"),
                            "--alignment",
                            "none",
                            "--association",
                            association,
                            "--json"});
  };
  const Outcome scored = evaluate("interpolate");
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const Json result = Json::parse(scored.out);
  const Json& entry = result.at("estimates").at(0);
  EXPECT_EQ(entry.at("matched"), 20);
  EXPECT_EQ(entry.at("alignments").at("none").at("position_max_m"), 0.0);
  const std::string repeated =
      path("repeated.tum") + ": 1 poses (first in line 9) repeat the time of an earlier line";
  const std::string moved =
      path("backwards.tum") + ": 19 poses (first in line 2) are out of time order";
  EXPECT_THAT(result.at("warnings").at(0).get<std::string>(), HasSubstr(repeated));
  EXPECT_THAT(entry.at("warnings").at(0).get<std::string>(), HasSubstr(moved));
  EXPECT_THAT(scored.err, HasSubstr("warning: " + repeated));
  EXPECT_THAT(scored.err, HasSubstr("warning: " + moved));

  const Outcome by_number = evaluate("index");
  EXPECT_EQ(by_number.exit_code, 2);
  EXPECT_THAT(by_number.err, HasSubstr("repeated.tum: contains unknown poses"));
}

}  // namespace
}  // namespace overfly::testing
