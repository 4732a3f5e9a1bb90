#include "evaluation/statistics/roc_area.hpp"

#include <gtest/gtest.h>

namespace overfly::evaluation {
namespace {

TEST(RocArea, IsTheShareOfPairsInOrder) {
  EXPECT_EQ(roc_area({3.0, 4.0}, {1.0, 2.0}), 1.0);
  EXPECT_EQ(roc_area({1.0, 2.0}, {3.0, 4.0}), 0.0);
  // Pairs in order: 0.35 > 0.1; 0.8 > both; 0.35 < 0.4. An example of scikit-learn's documentation.
  EXPECT_EQ(roc_area({0.35, 0.8}, {0.1, 0.4}), 0.75);
}

TEST(RocArea, CountsEqualScoresHalf) {
  EXPECT_EQ(roc_area({1.0, 1.0}, {1.0}), 0.5);
  EXPECT_EQ(roc_area({1.0, 2.0}, {1.0, 0.0}), 0.875);
}

TEST(RocArea, IsEmptyWithoutBothKinds) {
  EXPECT_FALSE(roc_area({}, {1.0}));
  EXPECT_FALSE(roc_area({1.0}, {}));
}

}  // namespace
}  // namespace overfly::evaluation
