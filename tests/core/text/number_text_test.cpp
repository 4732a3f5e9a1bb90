#include "core/text/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace overfly {
namespace {

TEST(NumberText, ParsesToTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3.0, -2.5e-300, 1e22, std::nextafter(1.0, 2.0)}) {
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(number_text(0.1), "0.1");
}

TEST(NumberText, IsShortForMessages) {
  EXPECT_EQ(short_text(20.200000000000003), "20.2");
  EXPECT_EQ(short_text(-1234567.0), "-1.23457e+06");
}

TEST(NumberText, GivesSecondsExactly) {
  EXPECT_EQ(seconds_text(1'500'000'001), "1.500000001");
  EXPECT_EQ(seconds_text(0), "0.000000000");
}

TEST(NumberText, CountsInSingularAndPlural) {
  EXPECT_EQ(counted(0, "gap"), "0 gaps");
  EXPECT_EQ(counted(1, "gap"), "1 gap");
  EXPECT_EQ(counted(12, "gap"), "12 gaps");
}

}  // namespace
}  // namespace overfly
