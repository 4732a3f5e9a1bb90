#include "server/views/video/live_encoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>

#include <cmath>
#include <memory>

#include "server/files/jpeg.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

using overfly::testing::textured_image;
using ::testing::HasSubstr;

constexpr int kWidthPx = 320;
constexpr int kHeightPx = 240;

/// A part of a texture that moves by whole pixels, as a camera sees the ground.
Image view_of(const Image& ground, int k) {
  Image view(kWidthPx, kHeightPx, ground.channels);
  for (int y = 0; y < kHeightPx; ++y) {
    for (int x = 0; x < kWidthPx; ++x) {
      for (int c = 0; c < ground.channels; ++c) view.at(x, y, c) = ground.at(x + k, y + 3 * k, c);
    }
  }
  return view;
}

double psnr_db(double squares, std::size_t count) {
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(count) / squares);
}

double grey_psnr_db(const Image& a, const Image& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    const double difference = static_cast<double>(a.data[i]) - b.data[i];
    squares += difference * difference;
  }
  return psnr_db(squares, a.data.size());
}

/// libvpx's decoder, of which the encoder knows nothing.
class Decoder {
 public:
  Decoder() { vpx_codec_dec_init(&codec_, vpx_codec_vp8_dx(), nullptr, 0); }
  ~Decoder() { vpx_codec_destroy(&codec_); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// Null if the packet cannot be decoded.
  const vpx_image_t* decode(const LivePacket& packet) {
    const auto size = static_cast<unsigned>(packet.bytes.size());
    if (vpx_codec_decode(&codec_, packet.bytes.data(), size, nullptr, 0) != VPX_CODEC_OK) {
      return nullptr;
    }
    vpx_codec_iter_t position = nullptr;
    return vpx_codec_get_frame(&codec_, &position);
  }
  /// The luma plane, which is the image of a grey camera.
  Image grey(const LivePacket& packet) {
    const vpx_image_t* decoded = decode(packet);
    EXPECT_NE(decoded, nullptr);
    Image image(kWidthPx, kHeightPx, 1);
    if (decoded == nullptr) return image;
    for (int y = 0; y < kHeightPx; ++y) {
      const std::uint8_t* row = decoded->planes[VPX_PLANE_Y] + y * decoded->stride[VPX_PLANE_Y];
      std::copy(row, row + kWidthPx, image.data.data() + static_cast<std::ptrdiff_t>(y) * kWidthPx);
    }
    return image;
  }

 private:
  vpx_codec_ctx_t codec_{};
};

TEST(LiveEncoder, HalvesTheBytesOfJpegsOfEqualQuality) {
  const Image ground = textured_image(kWidthPx + 40, kHeightPx + 120, 1, 3);
  auto encoder = LiveEncoder::open(kWidthPx, kHeightPx).value();
  Decoder decoder;
  std::size_t jpeg_bytes = 0;
  std::size_t video_bytes = 0;
  double jpeg_db = 0.0;
  double video_db = 0.0;
  constexpr int kPictures = 30;
  for (int k = 0; k < kPictures; ++k) {
    const Image view = view_of(ground, k);
    const auto jpeg = encode_jpeg(view, 75).value();
    jpeg_bytes += jpeg.size();
    jpeg_db += grey_psnr_db(view, decode_jpeg(jpeg).value());
    const LivePacket packet = encoder.encode(view, 75, false).value();
    EXPECT_EQ(packet.key, k == 0);
    video_bytes += packet.bytes.size();
    video_db += grey_psnr_db(view, decoder.grey(packet));
  }
  EXPECT_LT(2 * video_bytes, jpeg_bytes);
  EXPECT_GT(video_db / kPictures, jpeg_db / kPictures - 1.0);
}

TEST(LiveEncoder, KeepsColoursAndTheFullRange) {
  auto encoder = LiveEncoder::open(64, 48).value();
  Decoder decoder;
  for (const auto& [r, g, b] :
       {std::tuple(0, 0, 0), {255, 255, 255}, {200, 40, 90}, {10, 220, 30}}) {
    Image image(64, 48, 3);
    for (std::size_t i = 0; i < image.data.size(); i += 3) {
      image.data[i] = static_cast<std::uint8_t>(r);
      image.data[i + 1] = static_cast<std::uint8_t>(g);
      image.data[i + 2] = static_cast<std::uint8_t>(b);
    }
    const LivePacket packet = encoder.encode(image, 90, false).value();
    const vpx_image_t* decoded = decoder.decode(packet);
    ASSERT_NE(decoded, nullptr);
    const double y = decoded->planes[VPX_PLANE_Y][10 * decoded->stride[VPX_PLANE_Y] + 10];
    const double u = decoded->planes[VPX_PLANE_U][5 * decoded->stride[VPX_PLANE_U] + 5] - 128.0;
    const double v = decoded->planes[VPX_PLANE_V][5 * decoded->stride[VPX_PLANE_V] + 5] - 128.0;
    // JFIF 1.02, "Conversion to and from RGB".
    EXPECT_NEAR(y + 1.402 * v, r, 5.0);
    EXPECT_NEAR(y - 0.34414 * u - 0.71414 * v, g, 5.0);
    EXPECT_NEAR(y + 1.772 * u, b, 5.0);
  }
}

TEST(LiveEncoder, MakesAKeyPictureWhenItIsAskedTo) {
  const Image ground = textured_image(kWidthPx + 40, kHeightPx + 120, 1, 3);
  auto encoder = LiveEncoder::open(kWidthPx, kHeightPx).value();
  for (int k = 0; k < 4; ++k) ASSERT_TRUE(encoder.encode(view_of(ground, k), 75, false));
  const LivePacket key = encoder.encode(view_of(ground, 4), 75, true).value();
  EXPECT_TRUE(key.key);
  Decoder late;
  EXPECT_GT(grey_psnr_db(view_of(ground, 4), late.grey(key)), 25.0);
}

TEST(LiveEncoder, TakesOddSizesAndRefusesOthers) {
  auto encoder = LiveEncoder::open(33, 17).value();
  EXPECT_TRUE(encoder.encode(textured_image(33, 17, 3), 75, false));
  EXPECT_TRUE(encoder.encode(textured_image(33, 17, 1), 30, false));
  const auto other = encoder.encode(textured_image(34, 17, 1), 75, false);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("34 x 17 px: must be 33 x 17"));
  EXPECT_THAT(LiveEncoder::open(0, 17).error().message, HasSubstr("width_px = 0"));
  EXPECT_THAT(LiveEncoder::open(16384, 17).error().message, HasSubstr("must be in [1, 16383]"));
}

TEST(QuantiserLikeJpeg, FallsWithQuality) {
  int before = 63;
  for (int quality = 1; quality <= 100; ++quality) {
    const int quantiser = quantiser_like_jpeg(quality);
    EXPECT_LE(quantiser, before);
    EXPECT_GE(quantiser, 0);
    before = quantiser;
  }
}

}  // namespace
}  // namespace overfly::server
