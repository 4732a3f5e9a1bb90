#include "server/net/stream/playback_clock.hpp"

#include <gtest/gtest.h>

namespace overfly::net {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Of one run that flies: its newest instant is the end.
PlaybackClock::Extent flying_until(std::int64_t newest_ns) {
  return {0, newest_ns, true, newest_ns};
}

PlaybackClock finished(std::int64_t end_ns) {
  PlaybackClock clock({0, end_ns});
  clock.advance(0);
  return clock;
}

PlaybackClock playing(std::int64_t end_ns) {
  PlaybackClock clock = finished(end_ns);
  clock.play();
  return clock;
}

TEST(PlaybackClock, WaitsPausedAtTheStartOfAFinishedRun) {
  PlaybackClock clock = finished(10 * kSecond);
  clock.advance(5 * kSecond);
  EXPECT_EQ(clock.t_ns(), 0);
  EXPECT_FALSE(clock.playing());
  EXPECT_FALSE(clock.live());
}

TEST(PlaybackClock, PlaysByTheWallClockTimesTheSpeed) {
  PlaybackClock clock = playing(100 * kSecond);
  clock.advance(2 * kSecond);
  EXPECT_EQ(clock.t_ns(), 2 * kSecond);
  clock.set_speed(10.0);
  clock.advance(3 * kSecond);
  EXPECT_EQ(clock.t_ns(), 12 * kSecond);
  clock.set_speed(0.1);
  clock.advance(4 * kSecond);
  EXPECT_EQ(clock.t_ns(), 12 * kSecond + kSecond / 10);
}

TEST(PlaybackClock, DoesNotCountTimeWhilePaused) {
  PlaybackClock clock = playing(100 * kSecond);
  clock.advance(kSecond);
  clock.pause();
  clock.advance(50 * kSecond);
  clock.play();
  clock.advance(51 * kSecond);
  EXPECT_EQ(clock.t_ns(), 2 * kSecond);
}

TEST(PlaybackClock, StopsAtTheEndAndPlaysAgainFromTheStart) {
  PlaybackClock clock = playing(3 * kSecond);
  clock.advance(9 * kSecond);
  EXPECT_EQ(clock.t_ns(), 3 * kSecond);
  EXPECT_FALSE(clock.playing());
  clock.play();
  EXPECT_EQ(clock.t_ns(), 0);
  clock.advance(10 * kSecond);
  EXPECT_EQ(clock.t_ns(), kSecond);
}

TEST(PlaybackClock, LoopsWithWhatIsLeftOver) {
  PlaybackClock clock = finished(3 * kSecond);
  clock.set_loop(true);
  clock.play();
  clock.advance(4 * kSecond);
  EXPECT_TRUE(clock.playing());
  EXPECT_NEAR(static_cast<double>(clock.t_ns()), 1e9, 2);
}

TEST(PlaybackClock, ClampsSeeksToWhatIsRecorded) {
  PlaybackClock clock = finished(3 * kSecond);
  clock.seek(-5);
  EXPECT_EQ(clock.t_ns(), 0);
  clock.seek(1'000'000 * kSecond);
  EXPECT_EQ(clock.t_ns(), 3 * kSecond);
  EXPECT_FALSE(clock.playing());
}

TEST(PlaybackClock, PlaysOnAfterASeek) {
  PlaybackClock clock = playing(30 * kSecond);
  clock.seek(10 * kSecond);
  clock.advance(kSecond);
  EXPECT_EQ(clock.t_ns(), 11 * kSecond);
}

TEST(PlaybackClock, FollowsARunningRun) {
  PlaybackClock clock(flying_until(0));
  clock.advance(0);
  clock.set_extent(flying_until(2 * kSecond));
  clock.advance(60 * kSecond);
  EXPECT_TRUE(clock.live());
  EXPECT_EQ(clock.t_ns(), 2 * kSecond);
}

TEST(PlaybackClock, StandsPausedAtTheEndWhenTheLiveRunEnds) {
  PlaybackClock clock(flying_until(2 * kSecond));
  clock.set_extent({0, 3 * kSecond, false, 3 * kSecond});
  EXPECT_EQ(clock.t_ns(), 3 * kSecond);
  EXPECT_FALSE(clock.live());
  EXPECT_FALSE(clock.playing());
  EXPECT_FALSE(clock.go_live());
}

TEST(PlaybackClock, LeavesLiveBySeekPauseAndSpeed) {
  for (int how = 0; how < 3; ++how) {
    PlaybackClock clock(flying_until(5 * kSecond));
    if (how == 0) clock.seek(kSecond);
    if (how == 1) clock.pause();
    if (how == 2) clock.set_speed(0.5);
    EXPECT_FALSE(clock.live()) << how;
    EXPECT_EQ(clock.playing(), how != 1) << how;
    clock.set_extent(flying_until(6 * kSecond));
    EXPECT_LE(clock.t_ns(), 5 * kSecond) << how;
  }
}

TEST(PlaybackClock, BecomesLiveWhenItCatchesUp) {
  PlaybackClock clock(flying_until(5 * kSecond));
  clock.advance(0);
  clock.seek(4 * kSecond);
  clock.set_speed(2.0);
  clock.advance(kSecond / 4);
  EXPECT_FALSE(clock.live());
  clock.advance(kSecond);
  EXPECT_TRUE(clock.live());
  EXPECT_EQ(clock.t_ns(), 5 * kSecond);
  EXPECT_EQ(clock.speed(), 1.0);
}

TEST(PlaybackClock, StaysBehindAtALowerSpeed) {
  PlaybackClock clock(flying_until(5 * kSecond));
  clock.advance(0);
  clock.set_speed(0.5);
  clock.advance(kSecond / 10);
  EXPECT_FALSE(clock.live());
  EXPECT_TRUE(clock.playing());
  EXPECT_EQ(clock.t_ns(), 5 * kSecond);
  clock.set_extent(flying_until(8 * kSecond));
  clock.advance(kSecond / 10 + 2 * kSecond);
  EXPECT_EQ(clock.t_ns(), 6 * kSecond);
  EXPECT_FALSE(clock.live());
}

TEST(PlaybackClock, IgnoresAClockThatGoesBack) {
  PlaybackClock clock = playing(10 * kSecond);
  clock.advance(2 * kSecond);
  clock.advance(kSecond);
  EXPECT_EQ(clock.t_ns(), 2 * kSecond);
}

TEST(PlaybackClock, PlaysBackwards) {
  PlaybackClock clock = finished(10 * kSecond);
  clock.seek(6 * kSecond);
  clock.set_speed(-2.0);
  clock.play();
  clock.advance(kSecond);
  EXPECT_EQ(clock.t_ns(), 4 * kSecond);
  clock.advance(9 * kSecond);
  EXPECT_EQ(clock.t_ns(), 0);
  EXPECT_FALSE(clock.playing());
  clock.play();
  EXPECT_EQ(clock.t_ns(), 10 * kSecond);
}

TEST(PlaybackClock, LoopsBackwardsWithWhatIsLeftOver) {
  PlaybackClock clock = finished(3 * kSecond);
  clock.set_loop(true);
  clock.set_speed(-1.0);
  clock.play();
  EXPECT_EQ(clock.t_ns(), 3 * kSecond);
  clock.advance(4 * kSecond);
  EXPECT_TRUE(clock.playing());
  EXPECT_NEAR(static_cast<double>(clock.t_ns()), 2e9, 2);
}

TEST(PlaybackClock, RepeatsARange) {
  PlaybackClock clock = finished(20 * kSecond);
  clock.set_range(PlaybackClock::Range{4 * kSecond, 6 * kSecond});
  clock.set_loop(true);
  clock.seek(5 * kSecond);
  clock.play();
  clock.advance(2 * kSecond);
  EXPECT_NEAR(static_cast<double>(clock.t_ns()), 5e9, 2);
  clock.set_loop(false);
  clock.advance(9 * kSecond);
  EXPECT_EQ(clock.t_ns(), 6 * kSecond);
  EXPECT_FALSE(clock.playing());
  clock.play();
  EXPECT_EQ(clock.t_ns(), 4 * kSecond);
}

TEST(PlaybackClock, PlaysToTheEndFromBeyondTheRange) {
  PlaybackClock clock = finished(20 * kSecond);
  clock.set_range(PlaybackClock::Range{4 * kSecond, 6 * kSecond});
  clock.seek(15 * kSecond);
  clock.play();
  clock.advance(30 * kSecond);
  EXPECT_EQ(clock.t_ns(), 20 * kSecond);
}

TEST(PlaybackClock, ARangeOutsideTheRecordedTimeIsNotABound) {
  PlaybackClock clock = finished(3 * kSecond);
  clock.set_range(PlaybackClock::Range{3 * kSecond, 9 * kSecond});
  clock.seek(3 * kSecond);
  clock.play();
  EXPECT_EQ(clock.t_ns(), 0);
}

TEST(PlaybackClock, BeginsBeforeZeroWithARunThatIsShiftedBack) {
  PlaybackClock clock({-5 * kSecond, 10 * kSecond});
  EXPECT_EQ(clock.t_ns(), -5 * kSecond);
  clock.seek(-9 * kSecond);
  EXPECT_EQ(clock.t_ns(), -5 * kSecond);
}

TEST(PlaybackClock, FollowsTheRunThatFliesAmongLongerOnes) {
  PlaybackClock clock({0, 100 * kSecond});
  clock.advance(0);
  clock.set_extent({0, 100 * kSecond, true, 7 * kSecond});
  EXPECT_FALSE(clock.live());
  ASSERT_TRUE(clock.go_live());
  EXPECT_EQ(clock.t_ns(), 7 * kSecond);
  clock.set_extent({0, 100 * kSecond, true, 8 * kSecond});
  EXPECT_EQ(clock.t_ns(), 8 * kSecond);
  clock.set_extent({0, 100 * kSecond, false, 9 * kSecond});
  EXPECT_EQ(clock.t_ns(), 9 * kSecond);
  EXPECT_FALSE(clock.live());
  EXPECT_FALSE(clock.playing());
}

TEST(PlaybackClock, ARangeThatEndsBeforeTheNewestInstantIsRepeatedDuringAFlight) {
  PlaybackClock clock(flying_until(9 * kSecond));
  clock.advance(0);
  clock.set_range(PlaybackClock::Range{2 * kSecond, 4 * kSecond});
  clock.set_loop(true);
  clock.seek(3 * kSecond);
  clock.advance(2 * kSecond);
  EXPECT_NEAR(static_cast<double>(clock.t_ns()), 3e9, 2);
  EXPECT_FALSE(clock.live());
}

}  // namespace
}  // namespace overfly::net
