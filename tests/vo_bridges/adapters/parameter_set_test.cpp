#include "vo_bridges/adapters/parameter_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "vo_bridges/adapters/scene_points.hpp"

namespace overfly_adapters {
namespace {

using ::testing::HasSubstr;

ParameterSet example() {
  return ParameterSet({{"threshold", ParameterKind::kWhole, "7", 1, 255},
                       {"ratio", ParameterKind::kNumber, "0.12", 0, 1},
                       {"thread", ParameterKind::kAutoFlag, "auto", 0, 0},
                       {"add", ParameterKind::kAutoNumber, "auto", 0, 9}},
                      {{"low", {{"threshold", "2"}}, ""}, {"odd", {}, "is not for us"}});
}

std::string fault_of(const ParameterValues& wanted) {
  try {
    example().resolve(wanted);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "(none)";
}

TEST(ParameterSet, TakesDefaultThenPresetThenName) {
  EXPECT_EQ(example().resolve({}).at("threshold"), "7");
  EXPECT_EQ(example().resolve({{"preset", "low"}}).at("threshold"), "2");
  EXPECT_EQ(example().resolve({{"preset", "low"}, {"threshold", "9"}}).at("threshold"), "9");
}

TEST(ParameterSet, NamesWhatMayStandThere) {
  EXPECT_EQ(fault_of({{"threshold", "0"}}),
            "parameter threshold = '0': must be a whole number from 1 to 255");
  EXPECT_EQ(fault_of({{"threshold", "2.5"}}),
            "parameter threshold = '2.5': must be a whole number from 1 to 255");
  EXPECT_EQ(fault_of({{"ratio", "much"}}),
            "parameter ratio = 'much': must be a number from 0 to 1");
  EXPECT_EQ(fault_of({{"ratio", "nan"}}), "parameter ratio = 'nan': must be a number from 0 to 1");
  EXPECT_EQ(fault_of({{"thread", "yes"}}), "parameter thread = 'yes': must be true, false or auto");
  EXPECT_EQ(fault_of({{"add", "ten"}}),
            "parameter add = 'ten': must be a number from 0 to 9 or auto");
  EXPECT_EQ(fault_of({{"preset", "odd"}}), "parameter preset = 'odd': is not for us");
  EXPECT_EQ(fault_of({{"preset", "no"}}), "parameter preset = 'no': must be one of low");
}

TEST(ParameterSet, AsksForWhatWasWantedAlone) {
  const ParameterValues asked =
      example().asked_for({{"preset", "low"}, {"ratio", "0.5"}, {"thread", "auto"}});
  EXPECT_EQ(asked, (ParameterValues{{"threshold", "2"}, {"ratio", "0.5"}}));
}

TEST(ParameterSet, TellsOnlyWhatIsDecided) {
  EXPECT_EQ(decided(example().resolve({{"add", "3"}})),
            (ParameterValues{{"threshold", "7"}, {"ratio", "0.12"}, {"add", "3"}}));
}

TEST(ParametersInForce, AreComparedAsNumbersOfSinglePrecision) {
  EXPECT_NO_THROW(check_in_force({{"ratio", "0.12"}}, {{"ratio", "0.119999997"}}));
  EXPECT_NO_THROW(check_in_force({{"threshold", "7.0"}}, {{"threshold", "7"}}));
  EXPECT_THROW(check_in_force({{"threshold", "7"}}, {{"threshold", "5"}}), std::runtime_error);
  EXPECT_THROW(check_in_force({{"threshold", "7"}}, {}), std::runtime_error);
}

TEST(ParameterText, IsAsShortAsReadsBackTheSame) {
  EXPECT_EQ(text_of_number(0.12), "0.12");
  EXPECT_EQ(text_of_number(20.0), "20");
  EXPECT_EQ(text_of_number(1e20), "1e+20");
}

TEST(ScenePoints, HaveTheMiddleDepth) {
  EXPECT_EQ(median_depth({}), 0.0);
  EXPECT_EQ(median_depth({5.0, 1.0, 3.0}), 3.0);
}

TEST(ScenePoints, KeepToTheImageWhenDrawn) {
  RgbImage image;
  image.width_px = 8;
  image.height_px = 6;
  image.pixels.assign(3 * 8 * 6, 0);
  for (const double far : {-1e9, 1e9, -3.0, 7.0}) draw_square(&image, far, far, {{9, 9, 9}});
  EXPECT_EQ(image.pixels[0], 9) << "the corner of the square around (-3, -3)";
  EXPECT_EQ(image.pixels[3 * (4 * 8 + 4)], 9) << "that of the one around (7, 7)";
}

TEST(Quaternion, IsTheRotationsWhicheverComponentIsLargest) {
  // 120 deg about (1, 1, 1) takes x to y to z: q = (0.5, 0.5, 0.5, 0.5).
  const auto cyclic = quaternion_from({{0, 0, 1, 1, 0, 0, 0, 1, 0}});
  for (const double component : cyclic) EXPECT_NEAR(std::abs(component), 0.5, 1e-12);
  // Half turns about each axis.
  EXPECT_NEAR(std::abs(quaternion_from({{1, 0, 0, 0, -1, 0, 0, 0, -1}})[0]), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(quaternion_from({{-1, 0, 0, 0, 1, 0, 0, 0, -1}})[1]), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(quaternion_from({{-1, 0, 0, 0, -1, 0, 0, 0, 1}})[2]), 1.0, 1e-12);
}

}  // namespace
}  // namespace overfly_adapters
