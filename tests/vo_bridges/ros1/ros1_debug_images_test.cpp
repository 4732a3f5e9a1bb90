#include "vo_bridges/ros1/ros1_debug_images.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "middleware/ros1/messages.hpp"

namespace overfly::ros1 {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

ImageMessage::ConstPtr stamped(std::int64_t stamp_ns) {
  const ImageMessage::Ptr image(new ImageMessage);
  image->header.stamp = time_from_ns(stamp_ns);
  return image;
}

TEST(Ros1DebugImages, AreTakenAtOnceWithoutPatience) {
  DebugImages images;
  const auto begin = Clock::now();
  EXPECT_FALSE(images.take(1000, 0ms));
  const auto before = stamped(1000);
  images.deliver(before);
  EXPECT_EQ(images.take(1'000'000'000, 0ms), before) << "the newest that is there";
  EXPECT_FALSE(images.take(1000, 0ms)) << "taken once";
  EXPECT_LT(Clock::now() - begin, 500ms);
}

TEST(Ros1DebugImages, AreWaitedForWhileTheyComeInTime) {
  DebugImages images;
  const auto wanted = stamped(2'000'000'000);
  auto late = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(100ms);
    images.deliver(stamped(1'000'000'000));
    std::this_thread::sleep_for(100ms);
    images.deliver(wanted);
  });
  EXPECT_EQ(images.take(2'000'000'000, 20s), wanted);
  EXPECT_FALSE(images.take(3'000'000'000, 200ms)) << "it did not come";
  const auto begin = Clock::now();
  EXPECT_FALSE(images.take(4'000'000'000, 20s)) << "and is not waited for again";
  EXPECT_LT(Clock::now() - begin, 10s);
}

TEST(Ros1DebugImages, AreNotWaitedForWhenCancelled) {
  DebugImages images;
  const std::atomic<bool> cancel = true;
  const auto begin = Clock::now();
  EXPECT_FALSE(images.take(1000, 20s, &cancel));
  EXPECT_LT(Clock::now() - begin, 1s);
}

}  // namespace
}  // namespace overfly::ros1
