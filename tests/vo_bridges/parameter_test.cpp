#include "vo_bridges/parameter.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

TEST(Parameter, IsWrittenSoThatItReadsBack) {
  EXPECT_EQ(text_of(true), "true");
  EXPECT_EQ(text_of(false), "false");
  EXPECT_EQ(text_of(20.0), "20");
  EXPECT_EQ(std::stod(text_of(0.1)), 0.1);
  EXPECT_EQ(text_of(std::string("a b")), "a b");
}

TEST(Parameter, IsADecimalWithAPointWhereThatIsShortEnough) {
  EXPECT_EQ(text_of(1e5), "100000");
  EXPECT_EQ(text_of(-1e6), "-1000000");
  EXPECT_EQ(text_of(9007199254740992.0), "9007199254740992");
  EXPECT_EQ(text_of(0.1), "0.1");
  EXPECT_EQ(text_of(1e-4), "0.0001");
  EXPECT_EQ(text_of(-2.5e-9), "-0.0000000025");
  EXPECT_EQ(text_of(0.0), "0");
  EXPECT_EQ(text_of(1e300), "1e+300");
  EXPECT_EQ(text_of(1e-10), "1e-10");
  for (const double number :
       {1e5, 1e6, 1e15 / 3.0, 1e-4, -1e-4 / 3.0, -1e-9 * 4.0 / 3.0, 0.1, 1e300, 1e-300}) {
    EXPECT_EQ(std::stod(text_of(number)), number);
  }
}

}  // namespace
}  // namespace overfly
