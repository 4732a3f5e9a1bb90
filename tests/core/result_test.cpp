#include "core/result.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

Result<int> half(int value) {
  if (value % 2 != 0) return Error{ErrorCode::kInvalidArgument, "value is odd"};
  return value / 2;
}

TEST(Result, CarriesAValueOrAnError) {
  EXPECT_EQ(half(8).value(), 4);
  ASSERT_FALSE(half(7).ok());
  EXPECT_EQ(half(7).error().code, ErrorCode::kInvalidArgument);
}

TEST(Error, ContextIsPutInFront) {
  EXPECT_EQ(half(3).error().in("course.json").message, "course.json: value is odd");
}

TEST(Status, IsOkUntilItHasAnError) {
  EXPECT_TRUE(Status().ok());
  EXPECT_FALSE(Status(Error{ErrorCode::kIo, "disk full"}).ok());
}

}  // namespace
}  // namespace overfly
