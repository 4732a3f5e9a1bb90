#include "server/estimators/estimator_factory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace overfly::server {
namespace {

using ::testing::HasSubstr;

EstimatorSpec spec_of(const std::string& type, VoParameters parameters = {}) {
  EstimatorSpec spec;
  spec.name = "e";
  spec.type = type;
  spec.parameters = std::move(parameters);
  return spec;
}

TEST(NativeParameters, AreCheckedOfEachEstimatorBeforeItIsMade) {
  const Status status = check_native_parameters({spec_of("perfect", {{"scale", 0.0}}),
                                                 spec_of("drifting", {{"drift", 0.01}}),
                                                 spec_of("drifting", {{"drift", -1.0}}),
                                                 spec_of("drifting", {{"scene_depth_m", -5.0}}),
                                                 spec_of("feature", {{"levels", 17.0}})});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(status.error().message, HasSubstr("estimators.0.parameters.scale = 0"));
  EXPECT_THAT(status.error().message, HasSubstr("estimators.2.parameters.drift = -1"));
  EXPECT_THAT(status.error().message, HasSubstr("estimators.3.parameters.scene_depth_m = -5"));
  EXPECT_THAT(status.error().message, HasSubstr("estimators.4.parameters.levels = 17"));
  EXPECT_EQ(std::count(status.error().message.begin(), status.error().message.end(), '\n'), 3);
}

TEST(NativeParameters, ThatAPerfectEstimatorDoesNotUseAreAccepted) {
  EXPECT_TRUE(check_native_parameters({spec_of("perfect", {{"drift", 2.0}})}));
}

TEST(NativeMemory, IsThatOfTheType) {
  EXPECT_GT(own_bytes_per_px(spec_of("feature")), 150.0);
  EXPECT_GT(own_bytes_per_px(spec_of("feature", {{"levels", 16.0}, {"scale_factor", 1.01}})),
            own_bytes_per_px(spec_of("feature")) + 50.0);
  EXPECT_GE(own_bytes_per_px(spec_of("baseline_homography")), 24.0);
  for (const char* type : {"baseline_hold", "baseline_dead_reckoning", "perfect", "process"}) {
    EXPECT_EQ(own_bytes_per_px(spec_of(type)), 0.0) << type;
  }
}

}  // namespace
}  // namespace overfly::server
