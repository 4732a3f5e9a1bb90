// Noise sampled many places at a time against noise() at each place.
#include "terrain/decoration/noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "terrain/decoration/noise_line.hpp"

namespace overfly::terrain::synthesis {
namespace {

TEST(Noise, OfALineEqualsThatOfItsPlaces) {
  for (const float spacing : {0.093F, 0.93F, 2.7F}) {
    std::vector<float> x;
    for (int k = 0; k < 203; ++k) x.push_back(-71.3F + spacing * static_cast<float>(k));
    NoiseLine line(x.front(), x.back(), 5);
    std::vector<float> values(x.size());
    // Southwards in small steps, as an image is painted, then elsewhere and back.
    for (const float y : {3.2F, 2.9F, 2.1F, 1.9F, 0.1F, -0.4F, -1.0F, -7.5F, 40.0F, 40.9F, 41.0F}) {
      line.sample(x, y, values);
      for (std::size_t k = 0; k < x.size(); ++k) {
        ASSERT_EQ(values[k], noise(x[k], y, 5)) << x[k] << ' ' << y;
      }
    }
  }
}

TEST(Noise, OfACellEqualsThatOfItsPlaces) {
  NoiseInCell cell;
  for (int k = 0; k < 500; ++k) {
    const float x = -9.0F + 0.04F * static_cast<float>(k);
    const float y = 0.3F - 0.011F * static_cast<float>(k);
    const std::uint32_t seed = k < 400 ? 0 : 3;
    ASSERT_EQ(cell.at(x, y, seed), noise(x, y, seed)) << k;
  }
}

TEST(Noise, IsContinuousAndWithinItsLimits) {
  float last = noise(-4.0F, 0.7F, 9);
  float least = last;
  float most = last;
  for (int k = 1; k < 40000; ++k) {
    const float value = noise(-4.0F + 0.001F * static_cast<float>(k), 0.7F, 9);
    ASSERT_LT(std::abs(value - last), 0.01F) << k;
    last = value;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_GE(least, -1.0F);
  EXPECT_LE(most, 1.0F);
  EXPECT_GT(most - least, 0.5F);
}

}  // namespace
}  // namespace overfly::terrain::synthesis
