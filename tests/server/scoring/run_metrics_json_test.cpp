#include "server/scoring/run_metrics_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "server/record/run_folder.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using evaluation::AlignmentMode;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Metrics in which no two written fields have the same value.
RunMetrics full_metrics() {
  RunMetrics metrics;
  CameraMetrics camera;
  camera.frames = 21;
  camera.texture = {0.25, 0.375, true};
  camera.void_fraction_mean = 0.125;
  camera.void_fraction_max = 0.5;
  camera.mostly_void_frames = 6;
  camera.late_tiles = 3;
  camera.frames_with_late_tiles = 2;
  camera.faults = {{"blackout", 4}, {"noise", 5}};
  metrics.cameras = {camera, {}};
  metrics.cameras[1].name = "tilted";
  metrics.late_frames = 3;
  metrics.late_frame_ranges = {{1, 1}, {3, 4}};
  metrics.flight = {2.5, 60.25};
  EstimatorMetrics estimator;
  estimator.type = "feature";
  estimator.map_id = 2;
  estimator.answered = 18;
  estimator.unanswered = 1;
  estimator.dropped_frames = 2;
  estimator.dropped_frame_ranges = {{7, 8}};
  estimator.hashes_compared = 17;
  estimator.hash_mismatches = 1;
  estimator.crash = "signal 11";
  evaluation::Score& score = estimator.score;
  score.outcome = evaluation::Outcome::kCrashed;
  score.outcome_time_s = 2.25;
  score.outcome_distance_m = 56.5;
  score.relocalisations = 3;
  score.relocalised_at_s = 1.75;
  score.reset_count = 1;
  score.coverage = 0.75;
  score.initialised_at_s = 0.5;
  score.frames = 24;
  score.tracked_frames = 18;
  score.position_auc_limit_m = 10.0;
  evaluation::AlignmentScore sim3;
  sim3.mode = AlignmentMode::kSim3;
  sim3.S_world_vo = {
      3.5, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), Eigen::Vector3d(1.0, 1.0 / 3.0, -2.0)};
  sim3.matched = 18;
  sim3.position_m = {1.5, 1.25, 1.0, 4.0};
  sim3.rotation_deg = evaluation::ErrorStatistics{0.5, 0.375, 0.25, 1.5};
  sim3.rotation_euler_norm_deg.emplace().rmse = 0.75;
  sim3.position_rmse_hold_m = 5.5;
  sim3.position_auc = 0.4375;
  sim3.relative.push_back({100.0, 7, 1.125, 0.0625});
  sim3.notes = {"only the longest map"};
  sim3.fix_drift = {{1000.0, 12, 3, 4.5, 9.25, 4.25, 9.0, ""},
                    {2000.0, 0, 0, 0.0, 0.0, 0.0, 0.0, "the scored path is 1200 m long"}};
  evaluation::Consistency& consistency = sim3.consistency.emplace();
  consistency.position = evaluation::nees_of({12.0, 20.0, 4.0, 12.0}, 3);
  consistency.pose = evaluation::nees_of({6.0, 5.5}, 6);
  consistency.singular = 2;
  score.covariances = {16, 2};
  score.alignments[AlignmentMode::kSim3] = sim3;
  evaluation::AlignmentScore& se3 = score.alignments[AlignmentMode::kSe3];
  se3.mode = AlignmentMode::kSe3;
  se3.degenerate = "the path is straight";
  score.unavailable[AlignmentMode::kInitScale] = "no depth";
  metrics.estimators["f"] = estimator;
  metrics.estimators["p"].test_estimator = true;
  metrics.estimators["p"].camera = "tilted";
  return metrics;
}

Result<RunMetrics> read_changed(const std::function<void(Json&)>& change) {
  Json document = json_from(full_metrics());
  change(document);
  return run_metrics_from(document);
}

TEST(RunMetricsJson, IsReadAsItWasWritten) {
  const Json document = json_from(full_metrics());
  const auto read = run_metrics_from(Json::parse(document.dump()));
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(json_from(*read), document);
  EXPECT_EQ(document.at("camera").at("mostly_void_frames"), 6);
  EXPECT_FALSE(document.at("cameras").at("tilted").contains("mostly_void_frames"));
  EXPECT_FALSE(document.at("cameras").at("tilted").contains("late_tiles"));
  EXPECT_FALSE(document.at("cameras").at("tilted").contains("faults"));
  EXPECT_EQ(document.at("camera").at("late_frame_ranges"), Json::parse("[[1, 1], [3, 4]]"));
  EXPECT_FALSE(json_from(RunMetrics()).contains("cameras"));
  const Json& estimator = document.at("estimators").at("f");
  EXPECT_EQ(estimator.at("relocalisations"), 3);
  EXPECT_EQ(estimator.at("relocalised_at_s"), 1.75);
  EXPECT_EQ(estimator.at("covariances"), Json::parse(R"({"stated": 16, "left_out": 2})"));
  const Json& consistency = estimator.at("alignments").at("sim3").at("consistency");
  EXPECT_EQ(consistency.at("honesty"), "overconfident");
  EXPECT_EQ(consistency.at("position").at("deviation_ratio"), 2.0);
  EXPECT_TRUE(consistency.at("rotation").is_null());
  EXPECT_FALSE(document.at("estimators").at("p").contains("covariances"));
  EXPECT_FALSE(estimator.at("alignments").at("se3").contains("consistency"));
  EXPECT_EQ(estimator.at("alignments").at("sim3").at("position_auc"), 0.4375);
  EXPECT_TRUE(estimator.at("alignments").at("se3").at("position_auc").is_null());
  EXPECT_EQ(estimator.at("position_auc_limit_m"), 10.0);
  EXPECT_EQ(estimator.at("alignments").at("sim3").at("fix_drift").at(1),
            Json::parse(R"({"interval_m": 2000.0,
                            "unavailable": "the scored path is 1200 m long"})"));
}

TEST(RunMetricsJson, NumbersThatJsonCannotRepresentAreNull) {
  RunMetrics metrics = full_metrics();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  metrics.estimators["f"].score.alignments[AlignmentMode::kSim3].position_m.rmse = kNan;
  const std::string text = json_from(metrics).dump();
  const auto read = run_metrics_from(Json::parse(text));
  ASSERT_TRUE(read.ok()) << read.error().message;
  const auto& sim3 = read->estimators.at("f").score.alignments.at(AlignmentMode::kSim3);
  EXPECT_TRUE(std::isnan(sim3.position_m.rmse));
  EXPECT_EQ(json_from(*read).dump(), text);
}

TEST(RunMetricsJson, UnknownAndMissingFieldsAreNoFault) {
  const auto later = read_changed([](Json& document) {
    document["weather"] = 3;
    document["estimators"]["f"]["mood"] = "good";
    document["estimators"]["f"]["alignments"]["sim4"] = 1;
  });
  ASSERT_TRUE(later.ok()) << later.error().message;
  EXPECT_EQ(json_from(*later), json_from(full_metrics()));

  const auto earlier = read_changed([](Json& document) {
    document["estimators"]["f"].erase("unanswered");
    document["estimators"]["f"].erase("position_auc_limit_m");
    document["estimators"]["f"].erase("relocalisations");
    document["estimators"]["f"].erase("relocalised_at_s");
    document["estimators"]["f"]["alignments"]["se3"].erase("position_auc");
    document["estimators"]["f"]["alignments"]["sim3"].erase("S_world_vo");
    document.erase("flight");
  });
  ASSERT_TRUE(earlier.ok()) << earlier.error().message;
  const EstimatorMetrics& estimator = earlier->estimators.at("f");
  EXPECT_EQ(estimator.unanswered, 0);
  EXPECT_FALSE(estimator.score.alignments.contains(AlignmentMode::kSim3)) << "has no transform";
  ASSERT_TRUE(estimator.score.alignments.contains(AlignmentMode::kSe3));
  EXPECT_FALSE(estimator.score.alignments.at(AlignmentMode::kSe3).position_auc.has_value());
  EXPECT_FALSE(estimator.score.position_auc_limit_m.has_value());
  EXPECT_FALSE(estimator.score.relocalisations.has_value());
  EXPECT_FALSE(estimator.score.relocalised_at_s.has_value());
}

TEST(RunMetricsJson, InvalidFieldIsNamed) {
  const auto message = [](const std::function<void(Json&)>& change) {
    const auto read = read_changed(change);
    return read ? std::string("fine") : read.error().message;
  };
  EXPECT_THAT(message([](Json& d) { d["estimators"]["f"]["outcome"] = "WON"; }),
              HasSubstr("estimators.f.outcome = \"WON\": must be an outcome"));
  EXPECT_THAT(message([](Json& d) { d["estimators"]["f"]["alignments"]["sim3"]["matched"] = "x"; }),
              HasSubstr("estimators.f.alignments.sim3.matched"));
  EXPECT_THAT(message([](Json& d) {
                d["estimators"]["f"]["alignments"]["sim3"]["consistency"]["pose"]["honesty"] = "so";
              }),
              HasSubstr("consistency.pose.honesty = \"so\": must be consistent"));
  EXPECT_THAT(message([](Json& d) { d.erase("estimators"); }), HasSubstr("estimators: is missing"));
  EXPECT_THAT(message([](Json& d) { d = Json::array(); }), HasSubstr("must be an object"));

  const overfly::testing::TemporaryFolder folder;
  EXPECT_EQ(read_run_metrics(folder.path()).error().code, ErrorCode::kNotFound);
  overfly::testing::write_text(metrics_file(folder.path()), "{}");
  EXPECT_THAT(read_run_metrics(folder.path()).error().message,
              HasSubstr("metrics.json: camera: is missing"));
}

TEST(RunMetricsJson, AnEstimatorFindsItsCameraByName) {
  RunMetrics metrics = full_metrics();
  metrics.cameras.push_back({});
  metrics.cameras.back().name = "ahead";
  metrics.cameras.back().texture.limited = true;
  metrics.estimators["a"].camera = "ahead";
  metrics.estimators["gone"].camera = "another";
  // In the file the further cameras are ordered by name.
  const Result<RunMetrics> read = run_metrics_from(json_from(metrics));
  ASSERT_TRUE(read) << read.error().message;
  const auto camera_of = [&](const std::string& name) -> const CameraMetrics& {
    return read->camera_of(read->estimators.at(name));
  };
  EXPECT_EQ(camera_of("f").frames, 21);
  EXPECT_EQ(camera_of("p").name, "tilted");
  EXPECT_FALSE(camera_of("p").texture.limited);
  EXPECT_TRUE(camera_of("a").texture.limited);
  EXPECT_EQ(camera_of("gone").frames, 21) << "the main camera's, if the file lacks that camera";
}

}  // namespace
}  // namespace overfly::server
