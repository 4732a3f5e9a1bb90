#include "server/net/stream/pictures/send_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <utility>

namespace overfly::net {
namespace {

constexpr std::int64_t kSendTickNs = 10'000'000;
constexpr std::uint32_t kStream = 1;

/// A client behind a link that carries pictures at a rate, after a time on the way.
class SendWindowTest : public ::testing::Test {
 protected:
  /// Sends pictures of a size whenever there is room.
  void play(double seconds, std::size_t picture_bytes, double link_bytes_per_s) {
    for (double t_s = 0.0; t_s < seconds; t_s += 0.01) {
      now_ns_ += kSendTickNs;
      while (!queue_.empty() && queue_.front().second + way_ns_ <= now_ns_) {
        window_.arrived(kStream, queue_.front().first);
        queue_.pop_front();
      }
      bool waits = false;
      if (now_ns_ >= due_ns_) {
        waits = !window_.has_room(picture_bytes);
        if (!waits) send(picture_bytes, link_bytes_per_s);
      }
      window_.note(waits, now_ns_);
      most_bytes_ = std::max(most_bytes_, window_.bytes_on_the_way());
    }
  }
  void send(std::size_t bytes, double link_bytes_per_s) {
    window_.reserve(kStream, bytes, now_ns_);
    window_.sent(kStream, sequence_, bytes);
    link_free_ns_ = std::max(link_free_ns_, now_ns_) +
                    static_cast<std::int64_t>(1e9 * static_cast<double>(bytes) / link_bytes_per_s);
    queue_.emplace_back(sequence_++, link_free_ns_);
    due_ns_ = now_ns_ + period_ns_;
    ++sent_;
  }

  SendWindow window_;
  std::deque<std::pair<std::uint32_t, std::int64_t>> queue_;  ///< number, end of transmission
  std::int64_t now_ns_ = 1;
  std::int64_t due_ns_ = 0;
  std::int64_t period_ns_ = 30'000'000;
  std::int64_t way_ns_ = 10'000'000;
  std::int64_t link_free_ns_ = 0;
  std::uint32_t sequence_ = 0;
  int sent_ = 0;
  std::size_t most_bytes_ = 0;
};

TEST_F(SendWindowTest, HasAlwaysRoomForOnePicture) {
  EXPECT_TRUE(window_.has_room(1U << 30U));
  window_.reserve(kStream, 1U << 30U, now_ns_);
  EXPECT_FALSE(window_.has_room(1)) << "while it is drawn";
  EXPECT_FALSE(window_.link_is_full(1)) << "the link has nothing to do with it";
  window_.release(kStream);
  EXPECT_TRUE(window_.has_room(1U << 30U)) << "it could not be drawn";
  window_.reserve(kStream, 1, now_ns_);
  window_.sent(kStream, 0, SendWindow::kFirstBytes);
  EXPECT_TRUE(window_.link_is_full(1));
}

TEST_F(SendWindowTest, CountsWhatIsOnTheWayUntilItArrives) {
  window_.reserve(kStream, 9, now_ns_);
  window_.sent(kStream, 0, 7);
  window_.reserve(2, 5, now_ns_);
  EXPECT_EQ(window_.bytes_on_the_way(), 12U);
  window_.arrived(2, 0);
  EXPECT_EQ(window_.bytes_on_the_way(), 12U) << "it is not sent yet";
  window_.arrived(kStream, 0);
  EXPECT_EQ(window_.bytes_on_the_way(), 5U);
  window_.forget(2);
  EXPECT_EQ(window_.bytes_on_the_way(), 0U);
}

TEST_F(SendWindowTest, HoldsWhatASlowLinkCarriesInLittleTime) {
  play(5.0, 6'000, 100'000);
  most_bytes_ = 0;
  play(10.0, 6'000, 100'000);
  const double delay_s = static_cast<double>(SendWindow::kMostDelayNs) / 1e9;
  EXPECT_LE(static_cast<double>(most_bytes_), 100'000 * delay_s + 6'000);
  EXPECT_GE(static_cast<double>(window_.limit_bytes()), 100'000 * delay_s / 2)
      << "it uses the link";
}

TEST_F(SendWindowTest, DoesNotLimitAFastLinkThatIsLong) {
  way_ns_ = 200'000'000;
  play(5.0, 20'000, 1e8);
  sent_ = 0;
  play(5.0, 20'000, 1e8);
  EXPECT_GE(sent_, 120) << "of 167 at 30 ms";
}

TEST_F(SendWindowTest, LetsLittleIntoALinkThatBecomesSlow) {
  play(10.0, 5'000, 1e8);
  most_bytes_ = 0;
  play(10.0, 5'000, 50'000);
  EXPECT_LE(most_bytes_, SendWindow::kFirstBytes) << "room that was not used is not kept";
}

TEST_F(SendWindowTest, GrowsAgainWhenTheLinkIsFast) {
  play(10.0, 20'000, 50'000);
  const std::size_t slow_bytes = window_.limit_bytes();
  way_ns_ = 100'000'000;
  play(10.0, 20'000, 1e8);
  EXPECT_GE(window_.limit_bytes(), 3 * slow_bytes);
  EXPECT_LE(window_.limit_bytes(), SendWindow::kMostBytes);
}

/// Slow playback: pictures of several streams are due together, and then the link rests.
TEST_F(SendWindowTest, GrowsUntilTheStreamsOfOneInstantHaveRoom) {
  constexpr std::size_t kBytes = 20'000;
  constexpr std::uint32_t kStreams = 4;
  std::deque<std::pair<std::uint32_t, std::int64_t>> arriving;
  std::uint32_t number = 0;
  std::uint32_t due = 0;
  int waited_ticks = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    now_ns_ += kSendTickNs;
    while (!arriving.empty() && arriving.front().second <= now_ns_) {
      window_.arrived(arriving.front().first, number);
      arriving.pop_front();
    }
    if (tick % 32 == 0) {
      due = kStreams;
      ++number;
    }
    for (; due > 0 && window_.has_room(kBytes); --due) {
      window_.reserve(due, kBytes, now_ns_);
      window_.sent(due, number, kBytes);
      arriving.emplace_back(due, now_ns_ + 40'000'000);
    }
    window_.note(due > 0, now_ns_);
    if (tick >= 1000 && due > 0) ++waited_ticks;
  }
  EXPECT_EQ(waited_ticks, 0) << "in the last ten seconds";
}

TEST_F(SendWindowTest, DoesNotWaitForEverForAClientThatReportsNothing) {
  window_.reserve(kStream, SendWindow::kMostBytes, now_ns_);
  window_.sent(kStream, 0, SendWindow::kMostBytes);
  window_.note(true, now_ns_ + SendWindow::kArrivedByNs);
  EXPECT_FALSE(window_.has_room(1));
  window_.note(true, now_ns_ + SendWindow::kArrivedByNs + 1);
  EXPECT_TRUE(window_.has_room(1));
}

}  // namespace
}  // namespace overfly::net
