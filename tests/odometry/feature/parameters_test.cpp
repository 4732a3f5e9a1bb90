#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "odometry/feature/feature_odometry.hpp"

namespace overfly::odometry::feature {
namespace {

using ::testing::HasSubstr;

TEST(FeatureParameters, TakeWhatIsGiven) {
  const auto parameters =
      feature_parameters_from({{"features", 1500}, {"scale_factor", 1.5}, {"seed", 9}});
  ASSERT_TRUE(parameters);
  EXPECT_EQ(parameters->features, 1500);
  EXPECT_DOUBLE_EQ(parameters->scale_factor, 1.5);
  EXPECT_EQ(parameters->seed, 9U);
  EXPECT_EQ(parameters->levels, 8);
}

TEST(FeatureParameters, NameTheUnknownKey) {
  const auto parameters = feature_parameters_from({{"feature", 1500}});
  ASSERT_FALSE(parameters);
  EXPECT_EQ(parameters.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(parameters.error().message, HasSubstr("parameters.feature:"));
}

TEST(FeatureParameters, NameFieldValueAndLimit) {
  const std::tuple<const char*, double, const char*> cases[] = {
      {"features", 99, "[100, 20000]"},
      {"features", 150.5, "whole"},
      {"features", std::nan(""), "whole"},
      {"scale_factor", 1.0, "(1, 2]"},
      {"scale_factor", std::nan(""), "(1, 2]"},
      {"levels", 17, "[1, 16]"},
      {"ini_fast_threshold", 0, "[1, 100]"},
      {"min_fast_threshold", 101, "[1, 100]"},
      {"min_fast_threshold", 21, "at most ini_fast_threshold = 20"},
      {"seed", -1, "[0, 2^53]"},
  };
  for (const auto& [field, value, limit] : cases) {
    const auto parameters = feature_parameters_from({{field, value}});
    ASSERT_FALSE(parameters) << field << " = " << value;
    EXPECT_THAT(parameters.error().message, HasSubstr(field));
    EXPECT_THAT(parameters.error().message, HasSubstr(limit));
  }
}

TEST(FeatureParameters, AreCheckedWhenCreatedDirectly) {
  FeatureParameters parameters;
  parameters.levels = 0;
  EXPECT_FALSE(create_feature_odometry(parameters));
}

TEST(FeatureParameters, AreReportedByTheirNames) {
  const auto odometry = create_feature_odometry({});
  ASSERT_TRUE(odometry);
  const auto reported = odometry.value()->effective_parameters();
  EXPECT_EQ(reported.at("features"), "2000");
  EXPECT_EQ(reported.at("scale_factor"), "1.2");
  EXPECT_EQ(reported.size(), 12U);
}

TEST(FeatureParameters, DetermineTheMemoryOfTheImages) {
  // Two maps with 50 images of 4/3 bytes per pixel are the least.
  const double usual = most_bytes_per_px({});
  EXPECT_GT(usual, 150.0);
  EXPECT_LT(usual, 250.0);
  FeatureParameters many;
  many.levels = 16;
  many.scale_factor = 1.001;
  EXPECT_GT(most_bytes_per_px(many), usual + 60.0);
}

}  // namespace
}  // namespace overfly::odometry::feature
