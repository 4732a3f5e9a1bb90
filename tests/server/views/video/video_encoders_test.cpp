#include "server/views/video/video_encoders.hpp"

#include <gtest/gtest.h>

#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

bool is_key(VideoEncoders& encoders, const VideoChain& chain, const Image& image) {
  const auto packet = encoders.encode(chain, image, 75);
  EXPECT_TRUE(packet && *packet);
  return packet && *packet && (*packet)->key;
}

TEST(VideoEncoders, AreKeptForTheirStreams) {
  const Image image = overfly::testing::textured_image(64, 48, 1);
  VideoEncoders encoders;
  EXPECT_TRUE(is_key(encoders, {1, 1, 0, false}, image));
  EXPECT_TRUE(is_key(encoders, {2, 1, 0, false}, image)) << "another viewer";
  EXPECT_FALSE(is_key(encoders, {1, 1, 1, false}, image));
  EXPECT_FALSE(is_key(encoders, {2, 1, 1, false}, image));
}

TEST(VideoEncoders, BeginAnewWhereTheChainIsBroken) {
  const Image image = overfly::testing::textured_image(64, 48, 1);
  VideoEncoders encoders;
  EXPECT_TRUE(is_key(encoders, {1, 1, 0, false}, image));
  EXPECT_TRUE(is_key(encoders, {1, 1, 0, false}, image)) << "the first one did not arrive";
  EXPECT_FALSE(is_key(encoders, {1, 1, 1, false}, image));
  EXPECT_TRUE(is_key(encoders, {1, 1, 2, true}, image)) << "asked for";
  EXPECT_TRUE(is_key(encoders, {1, 1, 3, false}, overfly::testing::textured_image(32, 24, 1)))
      << "of another size";
}

TEST(VideoEncoders, AreLimited) {
  const Image image = overfly::testing::textured_image(64, 48, 1);
  VideoEncoders encoders;
  for (std::uint32_t stream = 0; stream < VideoEncoders::kMost; ++stream) {
    EXPECT_TRUE(is_key(encoders, {1, stream, 0, false}, image));
  }
  const auto more = encoders.encode({1, 99, 0, false}, image, 75);
  ASSERT_TRUE(more);
  EXPECT_FALSE(*more);
  EXPECT_FALSE(is_key(encoders, {1, 0, 1, false}, image)) << "the others go on";
  encoders.forget(1);
  EXPECT_EQ(encoders.size(), 0U) << "a viewer that has gone takes no memory";
  EXPECT_TRUE(is_key(encoders, {1, 99, 0, false}, image));
}

TEST(VideoEncoders, TakePicturesOfALimitedSize) {
  VideoEncoders encoders;
  const Image largest(1920, 1440, 1);
  EXPECT_TRUE(is_key(encoders, {1, 1, 0, false}, largest));
  const auto larger = encoders.encode({1, 2, 0, false}, Image(1921, 1440, 1), 75);
  ASSERT_TRUE(larger);
  EXPECT_FALSE(*larger);
  EXPECT_EQ(encoders.size(), 1U);
}

TEST(VideoEncoders, ForgetOneViewerOnly) {
  const Image image = overfly::testing::textured_image(64, 48, 1);
  VideoEncoders encoders;
  EXPECT_TRUE(is_key(encoders, {1, 1, 0, false}, image));
  EXPECT_TRUE(is_key(encoders, {2, 1, 0, false}, image));
  encoders.forget(1);
  EXPECT_FALSE(is_key(encoders, {2, 1, 1, false}, image));
  EXPECT_TRUE(is_key(encoders, {1, 1, 1, false}, image));
}

}  // namespace
}  // namespace overfly::server
