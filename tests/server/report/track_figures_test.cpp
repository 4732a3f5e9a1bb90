// What the map of a flight shows of estimates that leave it.
#include "server/report/figures/track_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/report/report_fixture.hpp"

namespace overfly::server::report {
namespace {

using testing::add_estimator;
using testing::bent_run;
using ::testing::HasSubstr;
using ::testing::Not;

TrackingState tracking(std::int64_t /*frame*/) { return TrackingState::kTracking; }

/// The map of a flight of 200 m by 50 m and of an estimate that is off by `offset_m`.
std::string map_with(const Eigen::Vector3d& offset_m) {
  ReportContent content;
  content.runs.push_back(bent_run(100));
  add_estimator(content.runs[0], "e", tracking);
  for (ReportAnswer& answer : content.runs[0].estimates[0].answers) {
    answer.T_world_body->translation += offset_m;
  }
  const auto figures = track_figures(content, content.runs[0], entries_of(content, {0}), "f", {});
  EXPECT_TRUE(figures.ok());
  // Without the side views, which follow.
  return figures.ok() ? figures->substr(0, figures->find("class=\"pair\"")) : "";
}

/// One lost estimate must not shrink the flight to a dot.
TEST(TrackFigures, ShowEstimatesUpToTheSizeOfTheFlightAway) {
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0),
                                           Eigen::Vector3d(-1, 0, 0),
                                           Eigen::Vector3d(0, 1, 0),
                                           Eigen::Vector3d(0, -1, 0)}) {
    EXPECT_THAT(map_with(100.0 * direction), Not(HasSubstr("outside the picture")));
    EXPECT_THAT(map_with(2000.0 * direction),
                HasSubstr("100 % of the poses of e lie outside the picture."));
  }
}

}  // namespace
}  // namespace overfly::server::report
