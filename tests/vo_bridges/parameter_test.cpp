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

}  // namespace
}  // namespace overfly
