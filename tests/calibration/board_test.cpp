#include "calibration/board.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::calibration {
namespace {

/// Paints the squares and turns the painting by half a turn, square by square.
bool looks_the_same_turned(int cols, int rows) {
  const auto dark = [](int i, int j) { return (i + j) % 2 == 0; };
  for (int i = 0; i <= cols; ++i) {
    for (int j = 0; j <= rows; ++j) {
      if (dark(i, j) != dark(cols - i, rows - j)) return false;
    }
  }
  return true;
}

TEST(Board, IsSymmetricExactlyIfItsPaintingIs) {
  for (int cols = 3; cols <= 12; ++cols) {
    for (int rows = 3; rows <= 12; ++rows) {
      EXPECT_EQ((Board{cols, rows, 0.1}.half_turn_symmetric()), looks_the_same_turned(cols, rows))
          << cols << " x " << rows;
    }
  }
}

TEST(Board, RefusesBothOddAndBothEvenSizes) {
  for (const char* text : {"7x7", "9x5", "8x6"}) {
    const auto board = board_from_text(text, 0.1);
    ASSERT_TRUE(board.ok()) << text;
    EXPECT_FALSE(require_unambiguous(*board).ok()) << text;
  }
  const auto board = board_from_text("9x6", 0.1);
  ASSERT_TRUE(board.ok());
  EXPECT_TRUE(require_unambiguous(*board).ok());
}

TEST(Board, RefusalNamesSizesThatAreAccepted) {
  const Status status = require_unambiguous({7, 7, 0.1});
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("8x7"), std::string::npos) << status.error().message;
  EXPECT_NE(status.error().message.find("7x8"), std::string::npos) << status.error().message;
}

TEST(Board, ReadsSizeFromText) {
  const auto board = board_from_text("9x6", 0.025);
  ASSERT_TRUE(board.ok());
  EXPECT_EQ(board->cols, 9);
  EXPECT_EQ(board->rows, 6);
  EXPECT_DOUBLE_EQ(board->corner_m(10).x(), 0.025);
  EXPECT_DOUBLE_EQ(board->corner_m(10).y(), 0.025);
  for (const char* text :
       {"", "9", "9x", "x6", "9X6", "9x6x2", "-9x6", "9x6 ", "99999999999x6", "2x5", "61x6"}) {
    EXPECT_FALSE(board_from_text(text, 0.025).ok()) << text;
  }
  for (const double square_m : {0.0, -1.0, 11.0, std::nan("")}) {
    EXPECT_FALSE(board_from_text("9x6", square_m).ok()) << square_m;
  }
}

}  // namespace
}  // namespace overfly::calibration
