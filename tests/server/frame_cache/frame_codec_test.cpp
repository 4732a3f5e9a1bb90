// Pictures as bytes: equal to the bit, and damage is noticed.
#include "server/frame_cache/frame_codec.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

namespace overfly::server {
namespace {

using renderer::CameraFrame;
using renderer::CameraRequest;
using renderer::PixelFormat;

CameraRequest request_of(PixelFormat format, int width_px, int height_px) {
  PinholeCamera pinhole;
  pinhole.width_px = width_px;
  pinhole.height_px = height_px;
  pinhole.fx_px = pinhole.fy_px = 100.0;
  return CameraRequest::still(CameraModel(pinhole), {}, 77, format);
}

/// A picture with texture, smooth parts, and a frame of metadata.
CameraFrame picture_of(const CameraRequest& request, unsigned seed = 1) {
  std::mt19937 random(seed);
  CameraFrame frame;
  frame.t_ns = request.t_ns;
  frame.camera = request.camera;
  frame.T_world_camera.translation = {1.25, -1e7, 1e-300};
  frame.T_world_camera.rotation.coeffs() = Eigen::Vector4d(0.5, -0.5, 0.1, 0.7);
  frame.texels_per_pixel_min = 0.3;
  frame.texels_per_pixel_median = 0.7;
  frame.void_fraction = 1.0 / 3.0;
  frame.axis_depth_m = 299.125;
  const PinholeCamera& pinhole = request.camera.pinhole();
  const int channels = renderer::channel_count(request.format);
  if (renderer::is_linear(request.format)) {
    frame.radiance = RadianceImage(pinhole.width_px, pinhole.height_px, channels);
    std::uniform_real_distribution<float> value(0.0F, 1.0F);
    for (float& sample : frame.radiance.data) sample = value(random);
  } else {
    frame.image = Image(pinhole.width_px, pinhole.height_px, channels);
    std::uniform_int_distribution<int> value(0, 255);
    for (std::uint8_t& sample : frame.image.data) {
      sample = static_cast<std::uint8_t>(value(random));
    }
  }
  return frame;
}

void expect_equal(const CameraFrame& a, const CameraFrame& b) {
  EXPECT_EQ(a.image.data, b.image.data);
  EXPECT_EQ(a.image.width_px, b.image.width_px);
  EXPECT_EQ(a.image.channels, b.image.channels);
  ASSERT_EQ(a.radiance.data.size(), b.radiance.data.size());
  EXPECT_EQ(a.radiance.width_px, b.radiance.width_px);
  EXPECT_EQ(a.radiance.channels, b.radiance.channels);
  for (std::size_t i = 0; i < a.radiance.data.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a.radiance.data[i]),
              std::bit_cast<std::uint32_t>(b.radiance.data[i]))
        << i;
  }
  EXPECT_EQ(a.t_ns, b.t_ns);
  EXPECT_EQ(a.T_world_camera.translation, b.T_world_camera.translation);
  EXPECT_EQ(a.T_world_camera.rotation.coeffs(), b.T_world_camera.rotation.coeffs());
  EXPECT_EQ(a.camera.pinhole().fx_px, b.camera.pinhole().fx_px);
  EXPECT_EQ(a.texels_per_pixel_min, b.texels_per_pixel_min);
  EXPECT_EQ(a.texels_per_pixel_median, b.texels_per_pixel_median);
  EXPECT_EQ(a.void_fraction, b.void_fraction);
  EXPECT_EQ(a.axis_depth_m, b.axis_depth_m);
  EXPECT_EQ(a.late_tiles, b.late_tiles);
}

constexpr PixelFormat kFormats[] = {
    PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kGreyLinear, PixelFormat::kRgbLinear};

TEST(FrameCodec, GivesEveryPictureBackToTheBit) {
  FrameCodec codec;  // its memory is used again for other sizes and formats
  for (const PixelFormat format : kFormats) {
    for (const auto& [width_px, height_px] :
         {std::pair(64, 48), {1, 1}, {7, 1}, {1, 9}, {131, 67}}) {
      const CameraRequest request = request_of(format, width_px, height_px);
      const CameraFrame frame = picture_of(request);
      const std::span<const std::uint8_t> bytes = codec.encode(frame);
      EXPECT_LE(
          bytes.size(),
          largest_encoded_bytes(std::size_t(width_px) * height_px * renderer::channel_count(format),
                                renderer::is_linear(format) ? 4 : 1));
      const auto back = codec.decode(bytes, request);
      ASSERT_TRUE(back.ok()) << back.error().message;
      expect_equal(frame, *back);
    }
  }
}

TEST(FrameCodec, KeepsRadiancesOfEveryKind) {
  const CameraRequest request = request_of(PixelFormat::kGreyLinear, 4, 4);
  CameraFrame frame = picture_of(request);
  const float values[] = {0.0F,
                          -0.0F,
                          -1.5F,
                          std::numeric_limits<float>::denorm_min(),
                          std::numeric_limits<float>::max(),
                          std::numeric_limits<float>::lowest(),
                          std::numeric_limits<float>::infinity(),
                          std::bit_cast<float>(0x7FC12345U)};
  std::copy(std::begin(values), std::end(values), frame.radiance.data.begin() + 3);
  frame.axis_depth_m.reset();
  FrameCodec codec;
  const auto back = codec.decode(codec.encode(frame), request);
  ASSERT_TRUE(back.ok());
  expect_equal(frame, *back);
}

TEST(FrameCodec, NoticesEveryChangedByteAndEveryTruncation) {
  for (const PixelFormat format : kFormats) {
    const CameraRequest request = request_of(format, 8, 6);
    FrameCodec codec;
    const std::span<const std::uint8_t> encoded = codec.encode(picture_of(request));
    const std::vector<std::uint8_t> bytes(encoded.begin(), encoded.end());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      std::vector<std::uint8_t> damaged = bytes;
      damaged[i] ^= 0x10U;
      EXPECT_FALSE(codec.decode(damaged, request).ok()) << i;
    }
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(codec.decode(std::span(bytes).first(size), request).ok()) << size;
    }
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(codec.decode(longer, request).ok());
    EXPECT_TRUE(codec.decode(bytes, request).ok()) << "damage before must not matter";
  }
}

TEST(FrameCodec, RefusesAPictureOfAnotherSizeOrFormat) {
  FrameCodec codec;
  const auto bytes = codec.encode(picture_of(request_of(PixelFormat::kGrey8, 12, 8)));
  EXPECT_FALSE(codec.decode(bytes, request_of(PixelFormat::kGrey8, 8, 12)).ok());
  EXPECT_FALSE(codec.decode(bytes, request_of(PixelFormat::kRgb8, 4, 8)).ok());
  EXPECT_FALSE(codec.decode(bytes, request_of(PixelFormat::kGreyLinear, 12, 8)).ok());
}

/// A texture as over ground: neighbours are alike.
TEST(FrameCodec, TexturesTakeLessThanTheirSize) {
  std::mt19937 random(3);
  std::normal_distribution<float> step(0.0F, 4.0F);
  const CameraRequest grey = request_of(PixelFormat::kGrey8, 320, 240);
  const CameraRequest light = request_of(PixelFormat::kGreyLinear, 320, 240);
  CameraFrame image = picture_of(grey);
  CameraFrame radiance = picture_of(light);
  for (std::size_t i = 0; i < image.image.data.size(); ++i) {
    const float value =
        std::clamp(128.0F + 60.0F * std::sin(static_cast<float>(i % 320) * 0.02F) + step(random),
                   1.0F,
                   254.0F);
    image.image.data[i] = static_cast<std::uint8_t>(value);
    radiance.radiance.data[i] = value / 255.0F;
  }
  FrameCodec codec;
  const double samples = 320.0 * 240.0;
  EXPECT_LT(static_cast<double>(codec.encode(image).size()), 0.7 * samples);
  EXPECT_LT(static_cast<double>(codec.encode(radiance).size()), 0.8 * 4.0 * samples);
}

}  // namespace
}  // namespace overfly::server
