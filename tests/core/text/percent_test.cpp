#include "core/text/percent.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

TEST(Percent, HasTwoSignificantDigits) {
  EXPECT_EQ(percent_text(0.0607493), "6.1 %");
  EXPECT_EQ(percent_text(0.123457), "12 %");
  EXPECT_EQ(percent_text(0.5), "50 %");
  EXPECT_EQ(percent_text(0.00012345), "0.012 %");
}

TEST(Percent, NeverHidesThatAShareIsNotNoneOrAll) {
  EXPECT_EQ(percent_text(0.0), "0 %");
  EXPECT_EQ(percent_text(1.0), "100 %");
  EXPECT_EQ(percent_text(3e-8), "0.0000030 %");
  EXPECT_EQ(percent_text(0.999437), "99.944 %");
  EXPECT_EQ(percent_text(0.97), "97.0 %");
}

}  // namespace
}  // namespace overfly
