// Videos: colours, quality, stamps, and a file that a player can seek in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "server/export/video/video_panels.hpp"
#include "server/export/video/vp9_encoder.hpp"
#include "server/export/video/webm_file.hpp"
#include "tests/server/export/read_video.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

constexpr std::uint32_t kCues = 0x1C53BB6B;

/// A landscape of smooth waves with some fine structure, moving to the left.
Image picture(int width, int height, int step) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = x + 3.0 * step;
      const double wave = std::sin(u * 0.05) * std::cos(y * 0.07) * 60.0;
      const double fine = std::sin(u * 0.9) * std::sin(y * 0.8) * 8.0;
      image.at(x, y, 0) = static_cast<std::uint8_t>(120.0 + wave + fine);
      image.at(x, y, 1) = static_cast<std::uint8_t>(130.0 - wave * 0.5 + fine);
      image.at(x, y, 2) = static_cast<std::uint8_t>(90.0 + wave * 0.3);
    }
  }
  return image;
}

VideoSettings settings_of(int width, int height) {
  VideoSettings settings;
  settings.width_px = width;
  settings.height_px = height;
  return settings;
}

/// Writes `frames` pictures, `step_ms` apart, and returns what went in.
std::vector<PlanarImage> write_video(const fs::path& file,
                                     const VideoSettings& settings,
                                     int frames,
                                     int step_ms) {
  std::vector<PlanarImage> originals;
  auto encoder = Vp9Encoder::open(settings).value();
  auto webm = WebmFile::create(file, settings.width_px, settings.height_px).value();
  for (int i = 0; i < frames; ++i) {
    const Image rgb = picture(settings.width_px, settings.height_px, i);
    originals.push_back(planar_from_rgb(rgb));
    const auto packets = encoder.encode(rgb, std::int64_t{i} * step_ms).value();
    for (const VideoPacket& packet : packets) {
      EXPECT_TRUE(webm.add(packet).ok());
    }
  }
  EXPECT_TRUE(webm.finish(std::int64_t{frames} * step_ms).ok());
  return originals;
}

TEST(PlanarFromRgb, IsBt709InTheNarrowRange) {
  // ITU-R BT.709-6, items 3.2 to 3.4: E'Y = 0.2126 R + 0.7152 G + 0.0722 B,
  // CB = (B - Y) / 1.8556, CR = (R - Y) / 1.5748, quantised to 219 and 224 steps.
  const double colours[][3] = {
      {0, 0, 0}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {37, 200, 93}};
  for (const auto& [r, g, b] : colours) {
    Image rgb(2, 2, 3);
    for (int i = 0; i < 4; ++i) {
      rgb.at(i % 2, i / 2, 0) = static_cast<std::uint8_t>(r);
      rgb.at(i % 2, i / 2, 1) = static_cast<std::uint8_t>(g);
      rgb.at(i % 2, i / 2, 2) = static_cast<std::uint8_t>(b);
    }
    const double luma = (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255.0;
    const PlanarImage planar = planar_from_rgb(rgb);
    ASSERT_EQ(planar.y.size(), 4U);
    ASSERT_EQ(planar.u.size(), 1U);
    // Half a step of rounding, and the same again by the coefficients' 16 bits.
    EXPECT_NEAR(planar.y[0], 16.0 + 219.0 * luma, 1.0);
    EXPECT_NEAR(planar.u[0], 128.0 + 224.0 * (b / 255.0 - luma) / 1.8556, 1.0);
    EXPECT_NEAR(planar.v[0], 128.0 + 224.0 * (r / 255.0 - luma) / 1.5748, 1.0);
  }
}

TEST(VideoPanels, ShrinkByTheMeanToEvenSides) {
  Image grey(10, 7, 1);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 10; ++x) grey.at(x, y) = static_cast<std::uint8_t>(10 * x + y);
  }
  const Image panel = panel_from(grey, 2);
  EXPECT_EQ(panel.width_px, 4);
  EXPECT_EQ(panel.height_px, 2);
  ASSERT_EQ(panel.channels, 3);
  // Pixels (2, 0), (3, 0), (2, 1), (3, 1): 20, 30, 21, 31.
  for (int c = 0; c < 3; ++c) EXPECT_EQ(panel.at(1, 0, c), 26);

  const Image both = side_by_side(panel, panel_from(Image(10, 4, 1, 7), 2));
  EXPECT_EQ(both.width_px, 8);
  EXPECT_EQ(both.at(1, 0, 2), 26);
  EXPECT_EQ(both.at(5, 1, 0), 7);
}

TEST(Video, DecodesToTheImagesThatWentIn) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "flight.webm";
  VideoSettings settings = settings_of(322, 178);
  settings.key_every = 8;
  const auto originals = write_video(file, settings, 20, 32);

  const testing::WebmContent webm = testing::read_webm(file);
  EXPECT_EQ(webm.doc_type, "webm");
  EXPECT_EQ(webm.codec, "V_VP9");
  EXPECT_EQ(webm.width_px, 322U);
  EXPECT_EQ(webm.height_px, 178U);
  EXPECT_EQ(webm.duration_ms, 640.0);
  ASSERT_EQ(webm.packets.size(), 20U);
  for (std::size_t i = 0; i < webm.packets.size(); ++i) {
    EXPECT_EQ(webm.packets[i].t_ms, static_cast<std::int64_t>(32 * i));
  }
  EXPECT_TRUE(webm.packets.front().key);
  EXPECT_GE(std::count_if(webm.packets.begin(),
                          webm.packets.end(),
                          [](const VideoPacket& packet) { return packet.key; }),
            2);

  const auto images = testing::decode_vp9(webm.packets);
  ASSERT_EQ(images.size(), originals.size());
  double worst_db = 1e9;
  for (std::size_t i = 0; i < images.size(); ++i) {
    worst_db = std::min(worst_db, testing::psnr_db(images[i].y, originals[i].y));
    EXPECT_GT(testing::psnr_db(images[i].u, originals[i].u), 30.0) << i;
    EXPECT_GT(testing::psnr_db(images[i].v, originals[i].v), 30.0) << i;
  }
  std::printf("[ VIDEO    ] worst luma %.1f dB, %zu bytes\n",
              worst_db,
              static_cast<std::size_t>(fs::file_size(file)));
  EXPECT_GT(worst_db, 30.0);
}

TEST(Video, CuesAndSeekHeadPointAtWhatTheyName) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "flight.webm";
  VideoSettings settings = settings_of(64, 48);
  settings.key_every = 50;
  // 100 s: clusters end for their length as well as before key images.
  write_video(file, settings, 100, 1000);
  const testing::WebmContent webm = testing::read_webm(file);
  ASSERT_EQ(webm.packets.size(), 100U);
  EXPECT_EQ(webm.packets.back().t_ms, 99'000);

  std::set<std::pair<std::uint64_t, std::uint64_t>> clusters;
  for (const auto& cluster : webm.clusters) clusters.emplace(cluster.position, cluster.t_ms);
  EXPECT_GE(clusters.size(), 4U);
  ASSERT_GE(webm.cues.size(), 2U);
  for (const auto& cue : webm.cues) {
    EXPECT_TRUE(clusters.contains({cue.cluster_position, cue.t_ms})) << cue.t_ms << " ms";
  }
  ASSERT_EQ(webm.seeks.size(), 3U);
  EXPECT_EQ(webm.seeks.back().first, kCues);
  for (const auto& seek : webm.seeks) {
    EXPECT_NE(std::find(webm.elements.begin(), webm.elements.end(), seek), webm.elements.end())
        << "seek to " << seek.first;
  }
}

TEST(Video, EqualImagesGiveEqualBytesAndQualityChangesTheirNumber) {
  const TemporaryFolder folder;
  const VideoSettings settings = settings_of(160, 120);
  write_video(folder.path() / "a.webm", settings, 6, 40);
  write_video(folder.path() / "b.webm", settings, 6, 40);
  EXPECT_EQ(overfly::testing::read_text(folder.path() / "a.webm"),
            overfly::testing::read_text(folder.path() / "b.webm"));

  VideoSettings fine = settings;
  fine.quality = 95;
  VideoSettings coarse = settings;
  coarse.quality = 5;
  write_video(folder.path() / "fine.webm", fine, 6, 40);
  write_video(folder.path() / "coarse.webm", coarse, 6, 40);
  EXPECT_GT(fs::file_size(folder.path() / "fine.webm"),
            2 * fs::file_size(folder.path() / "coarse.webm"));
}

TEST(Video, AnUnfinishedFileLeavesNothingBehind) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "flight.webm";
  {
    auto encoder = Vp9Encoder::open(settings_of(64, 48)).value();
    auto webm = WebmFile::create(file, 64, 48).value();
    const auto packets = encoder.encode(picture(64, 48, 0), 0).value();
    for (const VideoPacket& packet : packets) {
      ASSERT_TRUE(webm.add(packet).ok());
    }
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Video, SaysWhatItCannotTake) {
  for (const auto& [width, height, quality, text] :
       {std::tuple{15, 48, 70, "video.width_px = 15: must be even and in [16, 16384]"},
        {64, 49, 70, "video.height_px = 49"},
        {64, 48, 0, "video.quality = 0: must be in [1, 100]"}}) {
    VideoSettings settings = settings_of(width, height);
    settings.quality = quality;
    const auto encoder = Vp9Encoder::open(settings);
    ASSERT_FALSE(encoder.ok());
    EXPECT_EQ(encoder.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(encoder.error().message, HasSubstr(text));
  }
  auto encoder = Vp9Encoder::open(settings_of(64, 48)).value();
  EXPECT_THAT(encoder.encode(picture(32, 48, 0), 0).error().message, HasSubstr("32 x 48 px"));
  ASSERT_TRUE(encoder.encode(picture(64, 48, 0), 5).ok());
  EXPECT_FALSE(encoder.encode(picture(64, 48, 1), 5).ok()) << "stamps must increase";

  const auto nowhere = WebmFile::create("/no/such/folder/f.webm", 64, 48);
  ASSERT_FALSE(nowhere.ok());
  EXPECT_EQ(nowhere.error().code, ErrorCode::kIo);
  EXPECT_THAT(nowhere.error().message, HasSubstr("/no/such/folder/f.webm"));
}

}  // namespace
}  // namespace overfly::server
