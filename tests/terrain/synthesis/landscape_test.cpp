// Quick tests of distances against the exact ones.
#include "terrain/synthesis/landscape/landscape.hpp"

#include <gtest/gtest.h>

#include "terrain/synthesis/landscape/ground.hpp"

namespace overfly::terrain::synthesis {
namespace {

class LandscapeDistances : public ::testing::Test {
 protected:
  static constexpr float kHalfM = 600.0F;
  static LandscapeOptions small() {
    LandscapeOptions options;
    options.half_m = kHalfM;
    options.reach_m = 50.0F;
    return options;
  }
  const Landscape land_ = Landscape::plan(small());
};

TEST_F(LandscapeDistances, OnlyWhatIsOutsideTheFenceIsSurelyOutside) {
  int sure = 0;
  int places = 0;
  int outside = 0;
  for (float x = -kHalfM; x < kHalfM; x += 1.9F) {
    for (float y = -kHalfM; y < kHalfM; y += 2.1F) {
      const Point uv = land_.airfield.to_uv(x, y);
      const float exact_m = land_.airfield.outside_m(uv.x, uv.y);
      outside += exact_m > 3.0F ? 1 : 0;
      ++places;
      if (!land_.airfield.surely_outside(uv.x, uv.y, 3.0F)) continue;
      ++sure;
      ASSERT_GT(exact_m, 3.0F) << x << ' ' << y;
    }
  }
  EXPECT_LT(outside, places);
  EXPECT_GT(sure, 9 * outside / 10) << "the quick test decides most places";
}

TEST_F(LandscapeDistances, OnlyWhatIsOutsideAYardIsSurelyOutside) {
  ASSERT_FALSE(land_.structures.yards.empty());
  for (const Yard& yard : land_.structures.yards) {
    int sure = 0;
    int outside = 0;
    for (float dx = -70.0F; dx < 70.0F; dx += 0.7F) {
      for (float dy = -70.0F; dy < 70.0F; dy += 0.9F) {
        const float x = yard.middle.x + dx;
        const float y = yard.middle.y + dy;
        const float exact_m = yard_m(yard, x, y);
        outside += exact_m > 4.0F ? 1 : 0;
        if (!surely_outside(yard, x, y, 4.0F)) continue;
        ++sure;
        ASSERT_GT(exact_m, 4.0F) << x << ' ' << y;
      }
    }
    EXPECT_GT(sure, outside / 2);
  }
}

}  // namespace
}  // namespace overfly::terrain::synthesis
