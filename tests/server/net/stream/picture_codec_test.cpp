#include "server/net/stream/pictures/picture_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace overfly::net {
namespace {

PictureHeader example_header() {
  PictureHeader header;
  header.stream_id = 0x01020304;
  header.sequence = 7;
  header.frame = 0x1122334455;
  header.t_ns = 32'258'065;
  header.width_px = 1280;
  header.height_px = 960;
  header.encoding = PictureEncoding::kJpegGrey;
  header.payload_bytes = 3;
  header.key = false;
  header.live = true;
  header.scale = {-2.0F, 100.0F, true};
  header.full_width_px = 2560;
  header.full_height_px = 1920;
  return header;
}

std::vector<std::uint8_t> message_of(const PictureHeader& header) {
  std::vector<std::uint8_t> message(kPictureHeaderBytes + header.payload_bytes, 0xAB);
  const auto bytes = encode_picture_header(header);
  std::copy(bytes.begin(), bytes.end(), message.begin());
  return message;
}

TEST(PictureCodec, LaysOutTheHeaderByteByByte) {
  // Written by hand from the table of docs/PROTOCOL.md.
  const std::array<std::uint8_t, 60> expected = {
      'O',  'V',  'F',  'L',  2,    0, 1,    0,     // magic, version, type
      0x04, 0x03, 0x02, 0x01, 7,    0, 0,    0,     // stream, sequence
      0x55, 0x44, 0x33, 0x22, 0x11, 0, 0,    0,     // frame
      0x11, 0x38, 0xEC, 0x01, 0,    0, 0,    0,     // t_ns = 32258065 = 0x01EC3811
      0x00, 0x05, 0xC0, 0x03, 1,    0, 60,   0,     // 1280, 960, grey, header length
      3,    0,    0,    0,    7,    0, 0,    0,     // payload, flags: live, scale, logarithmic
      0x00, 0x00, 0x00, 0xC0, 0x00, 0, 0xC8, 0x42,  // -2, 100
      0x00, 0x0A, 0x80, 0x07};                      // 2560, 1920
  EXPECT_EQ(encode_picture_header(example_header()), expected);
}

TEST(PictureCodec, ReadsWhatItWrote) {
  const auto decoded = decode_picture_header(message_of(example_header()));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->stream_id, 0x01020304U);
  EXPECT_EQ(decoded->frame, 0x1122334455);
  EXPECT_EQ(decoded->t_ns, 32'258'065);
  EXPECT_EQ(decoded->height_px, 960);
  EXPECT_TRUE(decoded->live);
  EXPECT_EQ(decoded->scale, example_header().scale);
  EXPECT_EQ(decoded->full_width_px, 2560);
  EXPECT_EQ(decoded->full_height_px, 1920);
}

TEST(PictureCodec, TellsVideoAndItsKeyPictures) {
  PictureHeader header = example_header();
  header.encoding = PictureEncoding::kVp8;
  header.key = true;
  const auto bytes = encode_picture_header(header);
  EXPECT_EQ(bytes[36], 3);
  EXPECT_EQ(bytes[44], 15);
  EXPECT_TRUE(decode_picture_header(message_of(header))->key);
  header.key = false;
  EXPECT_FALSE(decode_picture_header(message_of(header))->key);
}

TEST(PictureCodec, HasAScaleOnlyIfItSaysSo) {
  PictureHeader header = example_header();
  header.scale.reset();
  EXPECT_FALSE(decode_picture_header(message_of(header))->scale);
}

TEST(PictureCodec, KeepsNegativeFrames) {
  PictureHeader header = example_header();
  header.frame = -1;
  EXPECT_EQ(decode_picture_header(message_of(header))->frame, -1);
}

TEST(PictureCodec, RefusesMessagesThatAreNoWholePicture) {
  const auto good = message_of(example_header());
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(decode_picture_header(std::span(good).first(size))) << size;
  }
  for (const std::size_t at : {0U, 4U, 6U, 36U, 38U, 40U}) {
    auto bad = good;
    bad[at] ^= 0x40;
    EXPECT_FALSE(decode_picture_header(bad)) << at;
  }
}

}  // namespace
}  // namespace overfly::net
