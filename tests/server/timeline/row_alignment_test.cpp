#include "server/timeline/row_alignment.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_info.hpp"
#include "server/timeline/run_timeline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "evaluation/evaluation.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "server/views/view_ribbons.hpp"

namespace overfly::server {
namespace {

const Pose kMount{R_body_camera_nadir(), Eigen::Vector3d(0.3, 0.0, 0.1)};

/// A bent flight, and an estimate of it in a frame of its own at a third of the scale.
RunRecords bent_flight() {
  const Similarity S_vo_world{
      1.0 / 3.0,
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.2, 0.1, 1.0).normalized())),
      Eigen::Vector3d(1.0, -2.0, 0.5)};
  RunRecords records;
  CameraRecords& camera = records.cameras.at(kMainCamera);
  camera.T_body_camera = kMount;
  records.estimators.push_back({"a", "feature", {}});
  for (int k = 0; k < 60; ++k) {
    const double t_s = 0.1 * k;
    FrameRow frame;
    frame.frame = k;
    frame.t_ns = k * 100'000'000LL;
    frame.T_world_body = {
        R_world_body_from({0.1 * t_s, 0.02, 0.2 * t_s}),
        Eigen::Vector3d(20.0 * t_s, 3.0 * t_s * t_s, 100.0 + 5.0 * std::sin(t_s))};
    frame.T_world_camera = frame.T_world_body * kMount;
    frame.axis_depth_m = 100.0;
    camera.frames.push_back(frame);
    EstimateRecord estimate;
    estimate.sample.frame = k;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.map_id = k < 20 ? 0 : 1;
    estimate.sample.T_vo_camera = S_vo_world * frame.T_world_camera;
    records.estimators[0].records.push_back(estimate);
  }
  return records;
}

std::shared_ptr<RunTimeline> timeline_of(const RunRecords& records) {
  auto timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"a"});
  timeline->set_cameras({{"", PinholeCamera(), kMount}});
  for (const FrameRow& frame : records.main_camera().frames) timeline->append_frame(frame);
  for (const EstimateRecord& estimate : records.estimators[0].records) {
    EstimateRow row;
    row.sample = estimate.sample;
    timeline->append_estimate(0, row);
  }
  return timeline;
}

TEST(RowAlignment, BringsAnExactEstimateOntoTheTruth) {
  const RunRecords records = bent_flight();
  const auto timeline = timeline_of(records);
  timeline->set_metrics(metrics_from(records));
  const auto alignment = RowAlignment::of(*timeline, 0, "sim3");
  ASSERT_TRUE(alignment.ok()) << alignment.error().message;
  const EstimateRow row = timeline->estimates(0, 40, 1).front();
  const auto T_world_body = alignment->T_world_body(row);
  ASSERT_TRUE(T_world_body);
  const Pose truth = timeline->frames(40, 1).front().T_world_body;
  EXPECT_LT((T_world_body->translation - truth.translation).norm(), 1e-6);
  EXPECT_LT(rotation_angle_rad(T_world_body->rotation, truth.rotation), 1e-6);
}

TEST(RunTimeline, KeepsNoErrorsOfSinglePoses) {
  const RunRecords records = bent_flight();
  const auto timeline = timeline_of(records);
  const RunMetrics metrics = metrics_from(records);
  timeline->set_metrics(metrics);
  const evaluation::Score& all = metrics.estimators.at("a").score;
  const evaluation::Score& kept = timeline->metrics()->estimators.at("a").score;
  EXPECT_EQ(all.matched_t_ns.size(), 40U);
  EXPECT_TRUE(kept.matched_t_ns.empty());
  const auto mode = evaluation::AlignmentMode::kSim3;
  EXPECT_EQ(all.alignments.at(mode).position_errors_m.size(), 40U);
  EXPECT_TRUE(kept.alignments.at(mode).position_errors_m.empty());
  EXPECT_TRUE(kept.alignments.at(mode).rotation_errors_deg.empty());
  EXPECT_EQ(json_from(*timeline->metrics()), json_from(metrics));
}

TEST(RowAlignment, GivesRowsOfTheScoredMapOnly) {
  const RunRecords records = bent_flight();
  const auto timeline = timeline_of(records);
  timeline->set_metrics(metrics_from(records));
  const auto alignment = RowAlignment::of(*timeline, 0, "se3");
  ASSERT_TRUE(alignment.ok());
  EXPECT_FALSE(alignment->T_world_body(timeline->estimates(0, 10, 1).front()));
  EstimateRow lost = timeline->estimates(0, 40, 1).front();
  lost.sample.state = TrackingState::kLost;
  EXPECT_FALSE(alignment->T_world_body(lost));
}

TEST(RowAlignment, SaysWhyAnAlignmentCannotBeHad) {
  const RunRecords records = bent_flight();
  const auto timeline = timeline_of(records);
  const auto code = [&](const std::string& mode) {
    const auto alignment = RowAlignment::of(*timeline, 0, mode);
    return alignment ? std::string("fine") : std::string(to_string(alignment.error().code));
  };
  EXPECT_EQ(code("init_scale"), "fine");
  EXPECT_EQ(code("sim4"), "invalid_argument");
  EXPECT_EQ(code("sim3"), "conflict");
  RunMetrics metrics = metrics_from(records);
  evaluation::Score& score = metrics.estimators.at("a").score;
  score.alignments.erase(evaluation::AlignmentMode::kSim3);
  score.alignments.erase(evaluation::AlignmentMode::kSe3);
  score.unavailable[evaluation::AlignmentMode::kSe3] = "too few poses";
  timeline->set_metrics(std::move(metrics));
  EXPECT_EQ(code("sim3"), "conflict");
  const auto refused = RowAlignment::of(*timeline, 0, "se3");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("too few poses"), std::string::npos);
  EXPECT_FALSE(check_alignment(*timeline, "se3").ok());
  EXPECT_TRUE(check_alignment(*timeline, "origin").ok());
}

TEST(RowAlignment, MovesTheRibbons) {
  const RunRecords records = bent_flight();
  const auto timeline = timeline_of(records);
  timeline->set_metrics(metrics_from(records));
  ViewRibbons ribbons(timeline, "sim3");
  ribbons.refresh();
  const Pose now = timeline->frames(59, 1).front().T_world_body;
  const auto all = ribbons.until(timeline->frames(59, 1).front().t_ns, now, {});
  ASSERT_EQ(all.size(), 2U);  // the truth, and the map that was scored
  const Pose& first = all[1].T_world_body.front();
  EXPECT_LT((first.translation - timeline->frames(20, 1).front().T_world_body.translation).norm(),
            1e-6);
}

}  // namespace
}  // namespace overfly::server
