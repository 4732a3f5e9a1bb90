// Live images of an LCM channel, over the loopback's multicast.
#include <gtest/gtest.h>
#include <unistd.h>

#include "middleware/lcm/messages.hpp"
#include "middleware/lcm/node.hpp"
#include "server/imagery/live/live_images.hpp"

namespace overfly::server {
namespace {

using namespace std::chrono_literals;

TEST(LiveChannel, ReceivesTheNewestImage) {
  const Status multicast = lcm::probe_multicast("239.255.76.67");
  if (!multicast) GTEST_SKIP() << multicast.error().message;
  const std::string url =
      "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) + "?ttl=0";
  const auto address = parse_live_address("lcm:CAMERA@" + url, "camera");
  ASSERT_TRUE(address) << address.error().message;
  auto camera = open_live_images(*address, nullptr);
  ASSERT_TRUE(camera) << camera.error().message;
  const auto sender = lcm::Node::open(lcm::parse_url(url).value()).value();
  Image image(64, 48, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>(i % 251);
  }
  std::optional<Image> received;
  for (int turns = 0; turns < 100 && !received; ++turns) {
    const auto message = lcm::image_message(image, turns, turns * 1'000'000, 0, std::nullopt);
    ASSERT_TRUE(lcm::publish_message(*sender, "CAMERA", message));
    auto next = (*camera)->next(100ms);
    ASSERT_TRUE(next) << next.error().message;
    received = std::move(*next);
  }
  ASSERT_TRUE(received);
  EXPECT_EQ(received->data, image.data);
  // What is no image is named, and the next image is received.
  const std::vector<std::uint8_t> garbage(40, 7);
  while ((*camera)->next(10ms).value()) {
  }
  ASSERT_TRUE(sender->publish("CAMERA", garbage));
  EXPECT_FALSE((*camera)->next(5000ms));
  const auto again = lcm::image_message(image, 1, 1, 0, std::nullopt);
  ASSERT_TRUE(lcm::publish_message(*sender, "CAMERA", again));
  EXPECT_TRUE((*camera)->next(5000ms).value());
}

}  // namespace
}  // namespace overfly::server
