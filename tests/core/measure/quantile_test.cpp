#include "core/measure/quantile.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

TEST(Quantile, IsAValueThatOccurs) {
  EXPECT_EQ(quantile({}, 0.5), 0.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.0);
  std::vector<double> thousand(1000);
  for (int i = 0; i < 1000; ++i) thousand[i] = i + 1;
  EXPECT_EQ(quantile(thousand, 0.999), 999.0);
  EXPECT_EQ(quantile(thousand, 0.99), 990.0);
  EXPECT_EQ(quantile(thousand, 1.0), 1000.0);
}

}  // namespace
}  // namespace overfly
