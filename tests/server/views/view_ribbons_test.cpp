#include "server/views/view_ribbons.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_info.hpp"
#include "server/timeline/run_timeline.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

Pose at(double north_m) { return {Eigen::Quaterniond::Identity(), {0.0, north_m, 100.0}}; }

FrameRow frame_row(std::int64_t frame) {
  FrameRow row;
  row.frame = frame;
  row.t_ns = frame * 100;
  row.T_world_body = at(static_cast<double>(frame));
  return row;
}

EstimateRow estimate_row(std::int64_t frame, bool tracked, int map_id) {
  EstimateRow row;
  row.sample.frame = frame;
  row.sample.t_ns = frame * 100;
  row.sample.map_id = map_id;
  if (tracked) row.T_world_body = at(static_cast<double>(frame) + 0.5);
  return row;
}

TEST(ViewRibbons, EndsTheTruthAtTheInstantAsked) {
  const auto timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{});
  for (int i = 0; i < 100; ++i) timeline->append_frame(frame_row(i));
  ViewRibbons ribbons(timeline);
  ribbons.refresh();
  const auto cut = ribbons.until(4000, at(40.0), {});
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_EQ(cut[0].T_world_body.back().translation.y(), 40.0);
  EXPECT_EQ(cut[0].T_world_body.front().translation.y(), 0.0);
  for (std::size_t i = 1; i < cut[0].T_world_body.size(); ++i) {
    const double step =
        cut[0].T_world_body[i].translation.y() - cut[0].T_world_body[i - 1].translation.y();
    EXPECT_GT(step, 0.0);
    EXPECT_LE(step, 3.0);
  }
  EXPECT_EQ(ribbons.centre().y(), 49.5);
}

TEST(ViewRibbons, AreOutdatedOnceTheRunIsScoredAgain) {
  const auto timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"a"});
  const ViewRibbons unscored(timeline);
  EXPECT_FALSE(unscored.is_outdated());
  timeline->set_metrics(RunMetrics());
  EXPECT_TRUE(unscored.is_outdated());
  const ViewRibbons scored(timeline);
  EXPECT_FALSE(scored.is_outdated());
  timeline->set_metrics(RunMetrics());
  EXPECT_TRUE(scored.is_outdated());
}

TEST(ViewRibbons, GrowsWithTheRunAsIfReadAtOnce) {
  const auto timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"a"});
  ViewRibbons growing(timeline);
  for (int i = 0; i < 50; ++i) {
    timeline->append_frame(frame_row(i));
    timeline->append_estimate(0, estimate_row(i, i > 4, 0));
    growing.refresh();
  }
  ViewRibbons whole(timeline);
  whole.refresh();
  const auto a = growing.until(3000, at(30.0), {});
  const auto b = whole.until(3000, at(30.0), {});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].T_world_body.size(), b[i].T_world_body.size());
  }
}

TEST(ViewRibbons, BreaksAnEstimateWhereItIsLostOrStartsAgain) {
  const auto timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"a"});
  for (int i = 0; i < 90; ++i) {
    timeline->append_frame(frame_row(i));
    const bool lost = i >= 30 && i < 40;
    timeline->append_estimate(0, estimate_row(i, !lost, i < 60 ? 0 : 1));
  }
  ViewRibbons ribbons(timeline);
  ribbons.refresh();
  const auto all = ribbons.until(9000, at(89.0), {});
  ASSERT_EQ(all.size(), 4U);  // the truth; until the loss, after it, and after the reset
  EXPECT_EQ(all[1].rgb, estimator_rgb(0));
  EXPECT_LT(all[1].T_world_body.back().translation.y(), 30.0);
  EXPECT_EQ(all[2].T_world_body.front().translation.y(), 40.5);
  EXPECT_EQ(all[3].T_world_body.front().translation.y(), 60.5);
  EXPECT_NE(estimator_rgb(0), estimator_rgb(1));
}

}  // namespace
}  // namespace overfly::server
