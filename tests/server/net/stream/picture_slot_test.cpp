#include "server/net/stream/pictures/picture_slot.hpp"

#include <gtest/gtest.h>

namespace overfly::net {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(PictureSlot, HasOnePictureInFlightAndKeepsTheNewest) {
  PictureSlot slot(1000.0);
  slot.want({1, 0});
  EXPECT_EQ(slot.take(0)->frame, 1);
  slot.want({2, 0});
  slot.want({3, 0});
  EXPECT_FALSE(slot.take(10 * kMs));
  slot.done();
  EXPECT_EQ(slot.take(20 * kMs)->frame, 3);
}

TEST(PictureSlot, DrawsNothingTwice) {
  PictureSlot slot(10.0);
  slot.want({1, 0});
  ASSERT_TRUE(slot.take(0));
  slot.done();
  slot.want({1, 0});
  EXPECT_FALSE(slot.waiting());
  EXPECT_FALSE(slot.take(1000 * kMs));
}

TEST(PictureSlot, KeepsItsRateThoughTicksComeLate) {
  PictureSlot slot(10.0);
  int taken = 0;
  // Ticks every 16 ms never hit a multiple of 100 ms.
  for (std::int64_t now_ms = 0; now_ms < 10'000; now_ms += 16) {
    slot.want({now_ms, 0});
    if (slot.take(now_ms * kMs)) ++taken;
    slot.done();
  }
  EXPECT_NEAR(taken, 100, 1);
}

TEST(PictureSlot, CatchesNothingUpAfterAPause) {
  PictureSlot slot(10.0);
  slot.want({1, 0});
  ASSERT_TRUE(slot.take(0));
  slot.done();
  slot.want({2, 0});
  ASSERT_TRUE(slot.take(5000 * kMs));
  slot.done();
  slot.want({3, 0});
  EXPECT_FALSE(slot.take(5001 * kMs));
}

TEST(PictureSlot, ShowsASeekSoonThoughTheStreamIsSlow) {
  PictureSlot slot(0.1);
  slot.want({1, 0});
  ASSERT_TRUE(slot.take(0));
  slot.done();
  slot.want({2, 0});
  EXPECT_FALSE(slot.take(100 * kMs));
  slot.want({2, 1});
  EXPECT_TRUE(slot.take(100 * kMs));
}

TEST(PictureSlot, NeverExceedsALimitNotEvenForASeek) {
  PictureSlot slot(31.0);
  slot.set_limit_hz(2.0);
  int taken = 0;
  for (std::int64_t now_ms = 0; now_ms < 10'000; now_ms += 16) {
    slot.want({now_ms, static_cast<std::uint64_t>(now_ms)});
    if (slot.take(now_ms * kMs)) ++taken;
    slot.done();
  }
  EXPECT_NEAR(taken, 20, 1);
  slot.set_limit_hz({});
  for (std::int64_t now_ms = 10'000; now_ms < 20'000; now_ms += 16) {
    slot.want({now_ms, 0});
    if (slot.take(now_ms * kMs)) ++taken;
    slot.done();
  }
  EXPECT_NEAR(taken, 330, 4);
}

TEST(PictureSlot, DoesNotAskAgainForAFrameThatALivePictureShowed) {
  PictureSlot slot(1000.0);
  slot.want({1, 0});
  ASSERT_TRUE(slot.take(0));
  slot.answered_with(2);
  slot.done();
  slot.want({2, 0});
  EXPECT_FALSE(slot.take(10 * kMs));
  slot.want({3, 0});
  EXPECT_TRUE(slot.take(20 * kMs));
}

}  // namespace
}  // namespace overfly::net
