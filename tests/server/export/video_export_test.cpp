// Flights as videos of the camera and of the aircraft from behind, with and without a data set.
#include "server/export/video_export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/export/export_fixture.hpp"
#include "tests/server/export/read_video.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::small_source;

VideoOptions video_options(const fs::path& file, VideoView view) {
  VideoOptions options;
  options.file = file;
  options.look.view = view;
  if (view == VideoView::kCamera) options.renderer_factory = testing::raycast_factory();
  return options;
}

TEST(VideoExport, ShowsWhatTheCameraSaw) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({"duration_s=1", "camera.rate_hz=31"});
  VideoOptions options = video_options(folder.path() / "camera.webm", VideoView::kCamera);
  options.from_s = 0.2;
  const auto summary = export_video(source, options);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  EXPECT_EQ(summary->frames, 25);

  const testing::WebmContent webm = testing::read_webm(options.file);
  EXPECT_EQ(webm.width_px, 160U);
  EXPECT_EQ(webm.height_px, 120U);
  ASSERT_EQ(webm.packets.size(), 25U);
  const auto frames = testing::frames_of(source.scenario);
  const auto images = testing::decode_vp9(webm.packets);
  ASSERT_EQ(images.size(), 25U);
  for (std::size_t i = 0; i < images.size(); ++i) {
    // 31 Hz is no whole number of milliseconds: each stamp is rounded by itself.
    const double exact_ms = double(frames[i + 7].t_ns - frames[7].t_ns) * 1e-6;
    EXPECT_LE(std::abs(double(webm.packets[i].t_ms) - exact_ms), 0.5);
    const PlanarImage seen = planar_from_rgb(panel_from(frames[i + 7].shots.front().image, 1));
    EXPECT_GT(testing::psnr_db(images[i].y, seen.y), 30.0) << "image " << i;
  }
}

TEST(VideoExport, ShowsARecordedImageThatCannotBeReadAsBlack) {
  const TemporaryFolder folder;
  std::string times;
  fs::create_directories(folder.path() / "images");
  for (int k = 0; k < 8; ++k) {
    const fs::path file = folder.path() / "images" / ("00" + std::to_string(k) + ".png");
    Image image(160, 120, 1);
    std::fill(image.data.begin(), image.data.end(), std::uint8_t{200});
    ASSERT_TRUE(write_png_file(file, image).ok());
    if (k == 4) overfly::testing::write_text(file, "no image");
    times += std::to_string(0.1 * k) + "\n";
  }
  overfly::testing::write_text(folder.path() / "times.txt", times);
  const ExportSource source =
      small_source({"camera.images.source=" + (folder.path() / "images").string(),
                    "camera.images.times=" + (folder.path() / "times.txt").string()});
  const VideoOptions options = video_options(folder.path() / "seen.webm", VideoView::kCamera);
  const auto summary = export_video(source, options);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  const auto images = testing::decode_vp9(testing::read_webm(options.file).packets);
  ASSERT_EQ(images.size(), 8U);
  EXPECT_GT(images[3].y[0], 150);
  EXPECT_LT(images[4].y[0], 40);
  EXPECT_GT(images[5].y[0], 150);
}

TEST(VideoExport, PutsTheChaseViewBesideTheCamera) {
  if (const auto egl = renderer::probe_egl(); !egl) GTEST_SKIP() << egl.error().message;
  const TemporaryFolder folder;
  const ExportSource source = small_source({"duration_s=0.3"});
  VideoOptions options = video_options(folder.path() / "both.webm", VideoView::kBoth);
  options.look.max_height_px = 60;
  ASSERT_TRUE(export_video(source, options).ok());
  const testing::WebmContent webm = testing::read_webm(options.file);
  EXPECT_EQ(webm.width_px, 160U);
  EXPECT_EQ(webm.height_px, 60U);
  ASSERT_EQ(webm.packets.size(), 4U);
  // The camera sees only ground; behind the aircraft there is also sky, which is blue.
  const PlanarImage last = testing::decode_vp9(webm.packets).back();
  const auto mean_blue = [&](int from, int to) {
    int sum = 0;
    for (int x = from; x < to; ++x) sum += last.u[static_cast<std::size_t>(2 * (160 / 2) + x)];
    return double(sum) / (to - from);
  };
  EXPECT_GT(mean_blue(40, 80), mean_blue(0, 40) + 3.0);
}

TEST(VideoExport, StandsBesideADataSet) {
  const TemporaryFolder folder;
  ExportOptions options = testing::export_options(folder.path() / "d", DatasetFormat::kTumMono);
  options.video = VideoLook{};
  options.video->view = VideoView::kCamera;
  testing::exported(small_source({"duration_s=0.4"}), options);
  EXPECT_EQ(testing::read_webm(folder.path() / "d" / "video.webm").packets.size(), 5U);
}

TEST(VideoExport, CancelledVideoEndsWithTheLastFrame) {
  const TemporaryFolder folder;
  std::atomic<bool> cancel = false;
  VideoOptions options = video_options(folder.path() / "cut.webm", VideoView::kCamera);
  options.cancel = &cancel;
  options.progress = [&](std::int64_t done, std::int64_t /*total*/) { cancel = done == 3; };
  const auto summary = export_video(small_source(), options);
  ASSERT_TRUE(summary.ok());
  EXPECT_TRUE(summary->cancelled);
  EXPECT_EQ(testing::read_webm(options.file).packets.size(), 3U);
}

TEST(VideoExport, NamesWhatIsInTheWay) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "there.webm";
  overfly::testing::write_text(file, "x");
  const auto there = export_video(small_source(), video_options(file, VideoView::kCamera));
  ASSERT_FALSE(there.ok());
  EXPECT_EQ(there.error().code, ErrorCode::kConflict);
  EXPECT_EQ(overfly::testing::read_text(file), "x");

  VideoOptions options = video_options(folder.path() / "new.webm", VideoView::kCamera);
  options.look.max_height_px = 8;
  const auto small = export_video(small_source(), options);
  ASSERT_FALSE(small.ok());
  EXPECT_THAT(small.error().message, HasSubstr("video.max_height_px = 8: must be at least 16"));
  EXPECT_FALSE(fs::exists(options.file));

  options = video_options(folder.path() / "none" / "new.webm", VideoView::kCamera);
  const auto nowhere = export_video(small_source(), options);
  ASSERT_FALSE(nowhere.ok());
  EXPECT_EQ(nowhere.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace overfly::server
