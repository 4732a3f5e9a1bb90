// Counters, timings and parameters of estimators: values that are not finite, too many names.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "tests/support/support.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"

namespace overfly {
namespace {

using ::testing::AllOf;
using testing::ground_frames;
using ::testing::HasSubstr;
using testing::python_estimator;
using testing::scripted;
using testing::started;

class ProcessFigures : public testing::ChildrenTest {};

TEST_F(ProcessFigures, FiguresThatAreNotFiniteAreLeftOutWithOneWarning) {
  const auto estimator = started(scripted("nan_figures"));
  for (const VoFrame& frame : ground_frames(3, 1.0, 1.0, 64, 48)) {
    const Result<VoEstimate> estimate = estimator->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->counters.count("parallax"), 0U);
    EXPECT_EQ(estimate->timing_ms, (std::map<std::string, double>{{"match", 1.5}}));
  }
  EXPECT_EQ(lines_with(*estimator, "not finite"),
            (std::vector<std::string>{"warning: counter parallax is not finite: this and later "
                                      "such values are ignored"}));
}

TEST_F(ProcessFigures, MapPointsThatAreNotFiniteAreLeftOutWithOneWarning) {
  const testing::TemporaryFolder folder;
  const ProcessEstimatorOptions python = python_estimator(
      "    def track(self, frame):\n"
      "        return overfly_vo.Answer(\n"
      "            map_points=[(1, 2, 3), (0, 0, float('inf')), (0, 1e39, 0)])\n",
      folder.path());
  for (const ProcessEstimatorOptions& options : {scripted("inf_point"), python}) {
    const auto estimator = started(options);
    estimator->set_debug(true);
    for (const VoFrame& frame : ground_frames(3, 1.0, 1.0, 64, 48)) {
      const Result<VoEstimate> estimate = estimator->track(frame);
      ASSERT_TRUE(estimate.ok()) << estimate.error().message;
      EXPECT_EQ(estimate->map_points_vo, (std::vector<Eigen::Vector3f>{{1.0F, 2.0F, 3.0F}}));
    }
    EXPECT_EQ(lines_with(*estimator, "not finite"),
              (std::vector<std::string>{"warning: a map point is not finite: this and later such "
                                        "values are ignored"}));
  }
}

TEST_F(ProcessFigures, FiguresOfPythonThatAreNotFiniteAreLeftOutWithOneWarning) {
  const testing::TemporaryFolder folder;
  const ProcessEstimatorOptions options = python_estimator(
      "    def track(self, frame):\n"
      "        return overfly_vo.Answer(\n"
      "            counters={'a': float('nan'), 'b': 2},\n"
      "            timings_ms={'c': float('-inf'), 'd': 0.5})\n",
      folder.path());
  const auto estimator = started(options);
  for (const VoFrame& frame : ground_frames(3, 1.0, 1.0, 64, 48)) {
    const Result<VoEstimate> estimate = estimator->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->counters, (std::map<std::string, double>{{"b", 2.0}}));
    EXPECT_EQ(estimate->timing_ms, (std::map<std::string, double>{{"d", 0.5}}));
  }
  EXPECT_THAT(lines_with(*estimator, "not finite"), ::testing::SizeIs(1));
}

TEST_F(ProcessFigures, NamesWithoutEndAreCutWithOneWarningForEachKind) {
  const auto estimator = started(scripted("many_names"));
  std::set<std::string> counters;
  std::set<std::string> timings;
  for (const VoFrame& frame : ground_frames(6, 1.0, 1.0, 64, 48)) {
    const Result<VoEstimate> estimate = estimator->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->timing_ms.at("match"), 1.5) << "a name that was there goes on";
    for (const auto& [name, value] : estimate->counters) counters.insert(name);
    for (const auto& [name, value] : estimate->timing_ms) timings.insert(name);
  }
  EXPECT_EQ(counters.size(), 256U);
  EXPECT_EQ(timings.size(), 256U);
  EXPECT_EQ(estimator->effective_parameters().size(), 4096U);
  EXPECT_THAT(lines_with(*estimator, "exceeds the limit"),
              ::testing::UnorderedElementsAre(
                  AllOf(HasSubstr("warning: counter c"), HasSubstr("limit of 256")),
                  AllOf(HasSubstr("warning: timing_ms t"), HasSubstr("limit of 256")),
                  AllOf(HasSubstr("warning: parameter p"), HasSubstr("limit of 4096"))));
}

}  // namespace
}  // namespace overfly
