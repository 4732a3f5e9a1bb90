// Lines of runs made by hand: their values, and their gaps.
#include "server/report/figures/estimate_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/report/run/flight_groups.hpp"
#include "server/report/run/words.hpp"
#include "tests/server/report/report_fixture.hpp"

namespace overfly::server::report {
namespace {

using testing::add_estimator;
using testing::bent_run;
using ::testing::EndsWith;

TrackingState always(std::int64_t) { return TrackingState::kTracking; }

/// Initialises for 1 s, and is lost from 4 s to 6 s.
TrackingState with_loss(std::int64_t frame) {
  if (frame < 10) return TrackingState::kInitialising;
  return frame >= 40 && frame < 60 ? TrackingState::kLost : TrackingState::kTracking;
}

std::size_t pieces_of(const std::vector<plot::Point>& line) {
  std::size_t pieces = 0;
  bool open = false;
  for (const plot::Point& point : line) {
    if (!point.is_gap() && !open) ++pieces;
    open = !point.is_gap();
  }
  return pieces;
}

std::size_t points_of(const std::vector<plot::Point>& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](const auto& p) { return !p.is_gap(); }));
}

TEST(EstimateLines, HaveGapsWhereTheEstimatorIsLost) {
  ReportRun run = bent_run(100);
  add_estimator(run, "a", with_loss);
  const ReportEstimate& estimate = run.estimates[0];
  for (const auto& line :
       {estimate_over_time(run, estimate, height_m), estimate_path(run, estimate, 0, 1)}) {
    EXPECT_EQ(pieces_of(line), 2U);
    EXPECT_EQ(points_of(line), 70U);
  }
  const auto& scored =
      run.metrics_of(estimate).score.alignments.at(evaluation::AlignmentMode::kNone);
  const auto errors = matched_over_time(run, estimate, scored.position_errors_m);
  EXPECT_EQ(pieces_of(errors), 2U);
  EXPECT_EQ(points_of(errors), 70U);
  for (const plot::Point& point : errors) {
    if (point.is_gap()) continue;
    EXPECT_NEAR(point.y, 1.0, 1e-9);
  }
  EXPECT_NEAR(errors.front().x, 1.0, 1e-12);
  EXPECT_EQ(points_of(truth_over_time(run, height_m)), 100U);
}

TEST(EstimateLines, HaveGapsWhereFramesAreMissing) {
  ReportRun run = bent_run(100);
  run.frames[0].erase(run.frames[0].begin() + 30, run.frames[0].begin() + 50);
  EXPECT_EQ(pieces_of(truth_over_time(run, height_m)), 2U);
  // One missing frame of ten a second is no gap.
  ReportRun dropped = bent_run(100);
  dropped.frames[0].erase(dropped.frames[0].begin() + 30);
  EXPECT_EQ(pieces_of(truth_over_time(dropped, height_m)), 1U);
  // At a low rate the frames themselves are far apart.
  ReportRun slow = bent_run(100);
  for (FrameRow& row : slow.frames[0]) row.t_ns *= 20;
  EXPECT_EQ(gap_limit_ns(slow.frames[0]), 6 * kNsPerS);
  EXPECT_EQ(pieces_of(truth_over_time(slow, height_m)), 1U);
}

TEST(EstimateLines, AttitudesAreThoseOfTheBody) {
  const Pose pose{R_world_body_from({rad_from_deg(30), rad_from_deg(-5), rad_from_deg(-10)}),
                  {1.0, 2.0, 3.0}};
  EXPECT_NEAR(roll_deg(pose), 30.0, 1e-9);
  EXPECT_NEAR(pitch_deg(pose), -5.0, 1e-9);
  EXPECT_NEAR(yaw_deg(pose), 350.0, 1e-9);
  EXPECT_EQ(height_m(pose), 3.0);
}

TEST(EstimateLines, BandsAreTheStates) {
  ReportRun run = bent_run(100);
  add_estimator(run, "a", with_loss);
  const auto bands = plot::joined_bands(state_bands(run, run.estimates[0]), {0.0, 9.9});
  ASSERT_EQ(bands.size(), 4U);
  EXPECT_EQ(bands[0].kind, plot::BandKind::kInitialising);
  EXPECT_NEAR(bands[0].to, 1.0, 1e-9);
  EXPECT_EQ(bands[2].kind, plot::BandKind::kLost);
  EXPECT_NEAR(bands[2].from, 4.0, 1e-9);
  EXPECT_NEAR(bands[2].to, 6.0, 1e-9);
  EXPECT_NEAR(bands[3].to, 9.9, 1e-9);
}

TEST(FlightGroups, AreByWhatWasFlown) {
  const ReportRun run = bent_run(100);
  ReportRun other_camera = bent_run(100);
  // Every third frame of the same flight.
  std::vector<FrameRow> third;
  for (std::size_t i = 0; i < 100; i += 3) third.push_back(other_camera.frames[0][i]);
  other_camera.frames[0] = third;
  EXPECT_TRUE(same_flight(run, other_camera));
  ReportRun shifted = bent_run(100);
  for (FrameRow& row : shifted.frames[0]) row.T_world_body.translation.y() += 0.2;
  EXPECT_FALSE(same_flight(run, shifted));
  ReportRun shorter = bent_run(80);
  EXPECT_FALSE(same_flight(run, shorter));
  ReportRun elsewhere = bent_run(100);
  elsewhere.manifest.world->origin = geodetic_from_deg(47.0, 8.0001, 500.0);
  EXPECT_FALSE(same_flight(run, elsewhere));
  const auto groups = flight_groups({run, shifted, other_camera, elsewhere});
  EXPECT_EQ(groups, (std::vector<std::vector<std::size_t>>{{0, 2}, {1}, {3}}));
}

TEST(Words, FiguresHaveFourDigits) {
  EXPECT_EQ(figure_text(3.41234), "3.412");
  EXPECT_EQ(figure_text(0.0341234), "0.03412");
  EXPECT_EQ(figure_text(-341.234), "-341.2");
  EXPECT_EQ(figure_text(34123.4), "34123");
  EXPECT_EQ(figure_text(0.0), "0");
  EXPECT_EQ(figure_text(1e-13), "< 1e-6");
  EXPECT_EQ(figure_text(2e12), "2.000e+12");
  EXPECT_EQ(figure_text(std::nullopt), "\xE2\x80\x93");
  EXPECT_EQ(figure_text(std::nan("")), "\xE2\x80\x93");
}

TEST(Words, SayWhatHappenedAndUnderWhichCircumstances) {
  ReportRun run = bent_run(100);
  run.frames[0][40].faults = {"blackout"};
  run.frames[0][40].saturated_fraction = 0.25;
  add_estimator(run, "a", [](std::int64_t frame) {
    return frame < 40 ? TrackingState::kTracking : TrackingState::kLost;
  });
  add_estimator(run, "b", always);
  // For 1.5 s.
  add_estimator(run, "c", [](std::int64_t frame) {
    return frame > 50 && frame < 66 ? TrackingState::kLost : TrackingState::kTracking;
  });
  // The integral of sqrt((20 m/s)^2 + (1 m/s^2 t)^2) over 4 s is 80.53 m.
  EXPECT_EQ(outcome_words(run.metrics_of(run.estimates[0])),
            "was lost at 4.0\xC2\xA0s, after 81\xC2\xA0m");
  EXPECT_EQ(outcome_text(run.metrics_of(run.estimates[0]).score),
            "LOST at 4.0\xC2\xA0s, after 81\xC2\xA0m");
  // The body turns by 0.1 rad/s about the vertical.
  EXPECT_EQ(circumstances(run, run.estimates[0]),
            "Then: bank 11 deg, pitch 0 deg, rotating at 6 deg/s, ground 100 m away along the "
            "optical axis, 2.000 texels per pixel, 25 % of the pixels saturated, faults: "
            "blackout.");
  EXPECT_EQ(outcome_words(run.metrics_of(run.estimates[1])), "completed the flight");
  EXPECT_EQ(circumstances(run, run.estimates[1]), "");
  EXPECT_EQ(relocalised_words(run.metrics_of(run.estimates[1]).score), "");
  EXPECT_THAT(outcome_text(run.metrics_of(run.estimates[2]).score),
              EndsWith("; found its map again at 6.6\xC2\xA0s"));
  EXPECT_NEAR(*percent_of_path(run, 2.0), 200.0 / run.metrics.flight.path_length_m, 1e-12);
}

}  // namespace
}  // namespace overfly::server::report
