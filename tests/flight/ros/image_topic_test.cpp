// Images on a topic reach a listener, of which the newest are kept; others are left out by size.
#include <gtest/gtest.h>
#include <ros/node_handle.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/node.hpp"
#include "middleware/ros1/topic_listener.hpp"
#include "tests/vo_bridges/ros1/ros_world.hpp"

namespace overfly::ros1 {
namespace {

using overfly::testing::RosMaster;
using namespace std::chrono_literals;

constexpr const char* kTopic = "/test_camera/image_raw";

struct Heard {
  std::mutex mutex;
  std::condition_variable changed;
  std::string type;
  std::size_t bytes = 0;
  void take(const ListenedMessage& message) {
    const std::lock_guard lock(mutex);
    type = message.type;
    bytes = message.bytes.size();
    changed.notify_all();
  }
  bool wait(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, patience, [&] { return bytes > 0; });
  }
};

TEST(ImageTopic, IsPassedOnToThoseWhoAskForImages) {
  if (!overfly::testing::has_rosmaster()) GTEST_SKIP() << "no rosmaster";
  RosMaster::instance().start();
  TopicListenerOptions options;
  options.master_uri = RosMaster::instance().uri();
  options.node_name = "overfly_flight_test";
  options.topics = {kTopic};
  Heard plain;
  Heard images;
  const auto take_plain = [&](const ListenedMessage& message) { plain.take(message); };
  const auto take_image = [&](const ListenedMessage& message) { images.take(message); };
  const auto small = TopicListener::open(options, take_plain, nullptr);
  ASSERT_TRUE(small) << small.error().message;
  options.images = true;
  const auto large = TopicListener::open(options, take_image, nullptr);
  ASSERT_TRUE(large) << large.error().message;

  ros::NodeHandle node;
  const ros::Publisher publisher = node.advertise<ImageMessage>(kTopic, 1);
  const ImageMessage message = message_from(Image(640, 480, 1, 90));
  for (int turns = 0; turns < 200 && !images.wait(50ms); ++turns) publisher.publish(message);
  EXPECT_EQ(images.type, "sensor_msgs/Image");
  EXPECT_GT(images.bytes, std::size_t{640 * 480});
  EXPECT_EQ((*large)->too_large(), 0U);
  // It is larger than what flights listen to.
  for (int turns = 0; turns < 100 && (*small)->too_large() == 0; ++turns) {
    publisher.publish(message);
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_GT((*small)->too_large(), 0U);
  EXPECT_FALSE(plain.wait(0ms));
}

}  // namespace
}  // namespace overfly::ros1
