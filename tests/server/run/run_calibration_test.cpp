// The photometric calibration and the deep images in a run's folder.
#include "server/run/run_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/outside/file_text.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run_options.hpp"
#include "terrain/raster/image_file.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using ::testing::SizeIs;

constexpr const char* kSensorAndNone =
    R"(cameras=[{"name":"plain","width_px":64,"height_px":48,"rate_hz":10},
                {"name":"deep","width_px":96,"height_px":64,"rate_hz":10,"bits":12,
                 "sensor":{"exposure_ms":3,"vignette":[-0.4,0,0],"shot_noise":true,
                           "response":{"shape":"gamma","gamma":2}}}])";

class RunCalibration : public ::testing::Test {
 protected:
  void SetUp() override {
    RunOptions options;
    options.folder = folder();
    const auto run = run_scenario(
        testing::small_scenario({kSensorAndNone,
                                 "duration_s=1",
                                 "recording.frames=true",
                                 "renderer.camera=raycast",
                                 R"(faults=[{"kind":"dropped_frames","at_s":0.3,"duration_s":0.2},
                                            {"kind":"stamp_offset","at_s":0.8,"duration_s":0.1,
                                             "offset_ms":20}])"}),
        options);
    ASSERT_TRUE(run.ok()) << run.error().message;
  }
  [[nodiscard]] fs::path folder() const { return temporary_.path() / "r"; }

 private:
  overfly::testing::TemporaryFolder temporary_;
};

std::vector<std::string> lines_of(const fs::path& file) {
  const auto text = read_file_text(file, 1 << 20);
  if (!text) throw std::runtime_error(text.error().message);
  std::istringstream in(*text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_F(RunCalibration, IsKeptOfCamerasWithASensorAlone) {
  EXPECT_FALSE(fs::exists(calibration_folder(folder(), "plain")));
  const fs::path kept = calibration_folder(folder(), "deep");
  std::istringstream numbers(lines_of(kept / "pcalib.txt").front());
  std::vector<double> irradiance;
  for (double value = 0.0; numbers >> value;) irradiance.push_back(value);
  ASSERT_THAT(irradiance, SizeIs(256));
  // The inverse of a square root, to within half a number: 12 bit share 16 numbers a value.
  for (std::size_t code = 1; code < 256; ++code) {
    const double expected = 255.0 * std::pow((code + 0.5) / 255.5, 2.0);
    EXPECT_NEAR(irradiance[code], expected, 0.02 * expected + 0.3) << code;
  }
  EXPECT_TRUE(fs::exists(kept / "vignette.png"));
}

TEST_F(RunCalibration, TimesMatchTheImagesThatArrived) {
  const auto lines = lines_of(calibration_folder(folder(), "deep") / "times.txt");
  ASSERT_THAT(lines, SizeIs(9));  // of 11
  EXPECT_EQ(lines[0], "000000 0.000000000 3");
  EXPECT_EQ(lines[3], "000005 0.500000000 3");
  EXPECT_EQ(lines[6], "000008 0.820000000 3") << "the stamp that estimators were told";
  for (const std::string& line : lines) {
    const std::string id = line.substr(0, 6);
    EXPECT_TRUE(fs::exists(folder() / "frames/deep" / (id + ".jpg"))) << id;
    EXPECT_TRUE(fs::exists(folder() / "frames16/deep" / (id + ".png"))) << id;
  }
  EXPECT_FALSE(fs::exists(folder() / "frames16/deep/000003.png"));
  EXPECT_FALSE(fs::exists(folder() / "frames16/000000.png")) << "the first camera has 8 bit";
}

}  // namespace
}  // namespace overfly::server
