#include "server/net/stream/playback_cursor.hpp"

#include <gtest/gtest.h>

namespace overfly::net {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

PlaybackCursor finished(std::int64_t end_ns) {
  PlaybackCursor cursor(false);
  cursor.set_extent(end_ns, false);
  cursor.advance(0);
  return cursor;
}

TEST(PlaybackCursor, WaitsPausedAtTheStartOfAFinishedRun) {
  PlaybackCursor cursor = finished(10 * kSecond);
  cursor.advance(5 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 0);
  EXPECT_FALSE(cursor.playing());
  EXPECT_FALSE(cursor.live());
}

TEST(PlaybackCursor, PlaysByTheWallClockTimesTheSpeed) {
  PlaybackCursor cursor = finished(100 * kSecond);
  cursor.play();
  cursor.advance(2 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 2 * kSecond);
  cursor.set_speed(10.0);
  cursor.advance(3 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 12 * kSecond);
  cursor.set_speed(0.1);
  cursor.advance(4 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 12 * kSecond + kSecond / 10);
}

TEST(PlaybackCursor, DoesNotCountTimeWhilePaused) {
  PlaybackCursor cursor = finished(100 * kSecond);
  cursor.play();
  cursor.advance(kSecond);
  cursor.pause();
  cursor.advance(50 * kSecond);
  cursor.play();
  cursor.advance(51 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 2 * kSecond);
}

TEST(PlaybackCursor, StopsAtTheEndAndPlaysAgainFromTheStart) {
  PlaybackCursor cursor = finished(3 * kSecond);
  cursor.play();
  cursor.advance(9 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 3 * kSecond);
  EXPECT_FALSE(cursor.playing());
  cursor.play();
  EXPECT_EQ(cursor.t_ns(), 0);
  cursor.advance(10 * kSecond);
  EXPECT_EQ(cursor.t_ns(), kSecond);
}

TEST(PlaybackCursor, LoopsWithWhatIsLeftOver) {
  PlaybackCursor cursor = finished(3 * kSecond);
  cursor.set_loop(true);
  cursor.play();
  cursor.advance(4 * kSecond);
  EXPECT_TRUE(cursor.playing());
  EXPECT_NEAR(static_cast<double>(cursor.t_ns()), 1e9, 2);
}

TEST(PlaybackCursor, ClampsSeeksToWhatIsRecorded) {
  PlaybackCursor cursor = finished(3 * kSecond);
  cursor.seek(-5);
  EXPECT_EQ(cursor.t_ns(), 0);
  cursor.seek(1'000'000 * kSecond);
  EXPECT_EQ(cursor.t_ns(), 3 * kSecond);
  EXPECT_FALSE(cursor.playing());
}

TEST(PlaybackCursor, PlaysOnAfterASeek) {
  PlaybackCursor cursor = finished(30 * kSecond);
  cursor.play();
  cursor.seek(10 * kSecond);
  cursor.advance(kSecond);
  EXPECT_EQ(cursor.t_ns(), 11 * kSecond);
}

TEST(PlaybackCursor, FollowsARunningRun) {
  PlaybackCursor cursor(true);
  cursor.set_extent(0, true);
  cursor.advance(0);
  cursor.set_extent(2 * kSecond, true);
  cursor.advance(60 * kSecond);
  EXPECT_TRUE(cursor.live());
  EXPECT_EQ(cursor.t_ns(), 2 * kSecond);
}

TEST(PlaybackCursor, StandsPausedAtTheEndWhenTheLiveRunEnds) {
  PlaybackCursor cursor(true);
  cursor.set_extent(2 * kSecond, true);
  cursor.set_extent(3 * kSecond, false);
  EXPECT_EQ(cursor.t_ns(), 3 * kSecond);
  EXPECT_FALSE(cursor.live());
  EXPECT_FALSE(cursor.playing());
  EXPECT_FALSE(cursor.go_live());
}

TEST(PlaybackCursor, LeavesLiveBySeekPauseAndSpeed) {
  for (int how = 0; how < 3; ++how) {
    PlaybackCursor cursor(true);
    cursor.set_extent(5 * kSecond, true);
    if (how == 0) cursor.seek(kSecond);
    if (how == 1) cursor.pause();
    if (how == 2) cursor.set_speed(0.5);
    EXPECT_FALSE(cursor.live()) << how;
    EXPECT_EQ(cursor.playing(), how != 1) << how;
    cursor.set_extent(6 * kSecond, true);
    EXPECT_LE(cursor.t_ns(), 5 * kSecond) << how;
  }
}

TEST(PlaybackCursor, BecomesLiveWhenItCatchesUp) {
  PlaybackCursor cursor(true);
  cursor.set_extent(5 * kSecond, true);
  cursor.advance(0);
  cursor.seek(4 * kSecond);
  cursor.set_speed(2.0);
  cursor.advance(kSecond / 4);
  EXPECT_FALSE(cursor.live());
  cursor.advance(kSecond);
  EXPECT_TRUE(cursor.live());
  EXPECT_EQ(cursor.t_ns(), 5 * kSecond);
}

TEST(PlaybackCursor, IgnoresAClockThatGoesBack) {
  PlaybackCursor cursor = finished(10 * kSecond);
  cursor.play();
  cursor.advance(2 * kSecond);
  cursor.advance(kSecond);
  EXPECT_EQ(cursor.t_ns(), 2 * kSecond);
}

}  // namespace
}  // namespace overfly::net
