// Folders of images with a file of times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/crc32.hpp"
#include "server/dataset/open_dataset.hpp"
#include "tests/server/dataset/dataset_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::plain_options;
using testing::write_image;
using testing::write_images;

class PlainFolder : public ::testing::Test {
 protected:
  void write_times(const std::string& text) const { write_text(path() / "times.txt", text); }
  [[nodiscard]] const fs::path& path() const { return folder_.path(); }
  [[nodiscard]] DatasetOptions options() const { return plain_options(path()); }
  [[nodiscard]] Dataset opened() const {
    Result<Dataset> dataset = open_dataset(options());
    if (dataset) return *dataset;
    ADD_FAILURE() << dataset.error().message;
    return {};
  }
  [[nodiscard]] std::vector<std::int64_t> times() const {
    std::vector<std::int64_t> times;
    for (const DatasetImage& image : opened().images) times.push_back(image.t_ns);
    return times;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const DatasetImage& image : opened().images) {
      names.push_back(image.file.filename().string());
    }
    return names;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(PlainFolder, PairsTimesAndImagesInTheOrderOfTheirNumbers) {
  for (const char* name : {"frame10.png", "frame9.png", "frame100.png"}) {
    write_image(path() / "images" / name);
  }
  write_text(path() / "images" / "readme.txt", "no image");
  write_times("# seconds\n0.5\n0.75\n1\n");
  EXPECT_THAT(names(), ElementsAre("frame9.png", "frame10.png", "frame100.png"));
  EXPECT_THAT(times(), ElementsAre(500'000'000, 750'000'000, 1'000'000'000));
}

TEST_F(PlainFolder, TellsSecondsFromNanoseconds) {
  write_images(path() / "images", 3);
  write_times("1700000000\n1700000001\n1700000003\n");
  EXPECT_EQ(times().back(), 1'700'000'003'000'000'000);
  write_times("1700000000000000000\n1700000000032258065\n1700000000064516129\n");
  EXPECT_EQ(times().back(), 1'700'000'000'064'516'129);
  write_times("0\n32258065\n64516129\n");
  EXPECT_THAT(times(), ElementsAre(0, 32'258'065, 64'516'129));
  // To the last digit, which a double does not hold.
  write_times("1700000000.032258065\n1700000000.064516129\n1700000000.096774194\n");
  EXPECT_EQ(times().front(), 1'700'000'000'032'258'065);
  DatasetOptions forced = options();
  write_times("0\n1\n2\n");
  forced.time_unit = TimeUnit::kNanoseconds;
  EXPECT_EQ(open_dataset(forced)->images.back().t_ns, 2);
  forced.time_unit = TimeUnit::kSeconds;
  EXPECT_EQ(open_dataset(forced)->images.back().t_ns, 2'000'000'000);
}

TEST_F(PlainFolder, TakesNamesAndExposuresBesideTheTimes) {
  write_images(path() / "images", 3);
  write_times("0.1 00002.png\n0.2 00000.png\n");
  EXPECT_THAT(names(), ElementsAre("00002.png", "00000.png"));
  write_times("100000000,00001.png\n200000000,00002.png\n");
  EXPECT_THAT(names(), ElementsAre("00001.png", "00002.png"));
  EXPECT_THAT(times(), ElementsAre(100'000'000, 200'000'000));
  write_times("00001 0.1 2.5\n00002 0.2 0\n");
  EXPECT_THAT(names(), ElementsAre("00001.png", "00002.png"));
  EXPECT_EQ(opened().images.front().exposure_ns, 2'500'000);
  EXPECT_EQ(opened().images.back().exposure_ns, 0);
}

TEST_F(PlainFolder, GivesFramesWithTheCameraAndTheChecksum) {
  write_images(path() / "images", 2);
  write_times("0.5\n0.75\n");
  const Dataset dataset = opened();
  const Result<VoFrame> frame = read_frame(dataset, 1);
  ASSERT_TRUE(frame.ok()) << frame.error().message;
  EXPECT_EQ(frame->index, 1);
  EXPECT_EQ(frame->t_ns, 750'000'000);
  EXPECT_EQ(frame->intrinsics.width_px, testing::kWidthPx);
  EXPECT_EQ(frame->intrinsics.height_px, testing::kHeightPx);
  EXPECT_EQ(frame->intrinsics.cx_px, 7.5);
  EXPECT_EQ(frame->image->at(3, 2), static_cast<std::uint8_t>(7 * 3 + 13 * 2 + 31));
  EXPECT_EQ(frame->image_crc32, crc32_of(*frame->image));
  EXPECT_TRUE(validate_vo_frame(*frame, nullptr).ok());
}

TEST_F(PlainFolder, KeepsTheFirstOfImagesWithTheSameTime) {
  write_images(path() / "images", 4);
  write_times("0.1\n0.3\n0.3\n0.4\n");
  const Dataset dataset = opened();
  ASSERT_EQ(dataset.images.size(), 3U);
  EXPECT_EQ(dataset.images[1].listed_at, (path() / "times.txt").string() + ":2");
  EXPECT_EQ(dataset.images[2].index, 3);  // its place among the lines
  EXPECT_THAT(dataset.warnings,
              ElementsAre(HasSubstr("times.txt: 1 images (first in line 3) repeat the time")));
}

TEST_F(PlainFolder, SortsImagesByTime) {
  write_images(path() / "images", 3);
  write_times("0.1\n0.3\n0.2\n");
  const Dataset dataset = opened();
  ASSERT_EQ(dataset.images.size(), 3U);
  EXPECT_EQ(dataset.images[1].t_ns, 200'000'000);
  EXPECT_EQ(dataset.images[1].index, 1);
  EXPECT_THAT(dataset.warnings,
              ElementsAre(HasSubstr("1 images (first in line 3) are out of time order")));
}

TEST_F(PlainFolder, SaysWhereTheTimesAreBroken) {
  write_images(path() / "images", 3);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"0.1\n0.2\n", "times.txt: 2 times, but"},
      {"0.1\n0.2\n0.3\n0.4\n", "contains 3 images: the numbers must be equal"},
      {"0.1\nnan\n0.3\n", "times.txt:2: column 1 = 'nan': must be a time in seconds"},
      {"0.1\ninf\n0.3\n", "times.txt:2: column 1 = 'inf': must be a time in seconds"},
      {"0.1\n0.2 0.3\n0.4\n", "times.txt:2: 2 columns: must be 1"},
      {"0.1 0.2 0.3 0.4\n", "times.txt:1: 4 columns: must be TIME"},
      {"", "times.txt: contains no times"},
      {"# 0.1\n", "times.txt: contains no times"},
      {"0.1 00000.png\n0.2 00007.png\n", "times.txt:2: "},
      {"0.1 00000.png\n0.2 00007.png\n", "00007.png: no such file"},
      {"00000 0.1 1\n00009 0.2 1\n", "times.txt:2: column 1 = '00009': no image of this name"},
      {"00000 0.1 nan\n", "times.txt:1: column 3 = 'nan': must be finite"},
      {"00000 0.1 -1\n", "times.txt:1: column 3 = '-1': an exposure must be in"},
  };
  for (const auto& [text, message] : cases) {
    write_times(text);
    EXPECT_THAT(error_of(options()), HasSubstr(message)) << text;
  }
}

TEST_F(PlainFolder, SaysWhatIsMissing) {
  DatasetOptions wanted = options();
  EXPECT_THAT(error_of(wanted), HasSubstr("images: no such folder"));
  write_images(path() / "images", 1);
  EXPECT_THAT(error_of(wanted), HasSubstr("times.txt: no such file"));
  write_times("0.1\n");
  wanted.camera.reset();
  EXPECT_THAT(error_of(wanted), HasSubstr("contains no calibration: the camera must be given"));
  wanted = options();
  wanted.camera = CameraModel(PinholeCamera{0, 0, -20, 20, 7.5, 5.5});
  EXPECT_THAT(error_of(wanted), HasSubstr("camera: "));
  wanted = options();
  wanted.sample_bits = 17;
  EXPECT_THAT(error_of(wanted), HasSubstr("sample bits = 17: must be in [8, 16]"));
  wanted = options();
  wanted.layout = DatasetLayout::kKitti;
  EXPECT_THAT(error_of(wanted), HasSubstr("not for layout kitti"));
  wanted = options();
  wanted.times.reset();
  EXPECT_THAT(error_of(wanted), HasSubstr("no data set of a known layout"));
}

TEST_F(PlainFolder, SaysWhichImageHasAnotherSize) {
  write_images(path() / "images", 2);
  write_image(path() / "images" / "00002.png", 0, 16, 13);
  write_times("0.1\n0.2\n0.3\n");
  const Result<VoFrame> frame = read_frame(opened(), 2);
  ASSERT_FALSE(frame.ok());
  EXPECT_THAT(frame.error().message, HasSubstr("times.txt:3: "));
  EXPECT_THAT(frame.error().message, HasSubstr("00002.png: 16 x 13 px: must be 16 x 12 px"));
  DatasetOptions sized = options();
  sized.camera = CameraModel(PinholeCamera{32, 24, 20, 20, 7.5, 5.5});
  const Result<Dataset> dataset = open_dataset(sized);
  ASSERT_TRUE(dataset.ok());
  EXPECT_THAT(read_frame(*dataset, 0).error().message, HasSubstr("must be 32 x 24 px"));
}

}  // namespace
}  // namespace overfly::server
