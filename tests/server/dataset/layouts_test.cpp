// The layouts of public data sets, with their calibrations as published, and each way to break
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "server/dataset/open_dataset.hpp"
#include "tests/server/dataset/dataset_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using testing::error_of;
using ::testing::HasSubstr;

DatasetOptions options_of(const fs::path& folder) {
  DatasetOptions options;
  options.folder = folder;
  return options;
}

Dataset opened(const DatasetOptions& options) {
  const Result<Dataset> dataset = open_dataset(options);
  if (dataset) return *dataset;
  ADD_FAILURE() << dataset.error().message;
  return {};
}

/// Replaces the first `from` in a file.
void change(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = read_text(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from << " is not in " << file;
  write_text(file, text.replace(at, from.size(), to));
}

/// One way to break a data set, and what is said of it.
struct Damage {
  std::string file;
  std::string from;
  std::string to;
  std::string message;
};

void expect_told(const std::function<void(const fs::path&)>& write,
                 const std::vector<Damage>& damages) {
  for (const Damage& damage : damages) {
    const TemporaryFolder folder;
    write(folder.path());
    change(folder.path() / damage.file, damage.from, damage.to);
    EXPECT_THAT(error_of(options_of(folder.path())), HasSubstr(damage.message));
  }
}

TEST(EurocLayout, IsReadWithItsCalibrationFromAnyOfItsFolders) {
  const TemporaryFolder folder;
  testing::write_euroc(folder.path());
  for (const fs::path& root : {folder.path(), folder.path() / "mav0"}) {
    const Dataset dataset = opened(options_of(root));
    EXPECT_EQ(dataset.layout, DatasetLayout::kEuroc);
    EXPECT_EQ(dataset.camera_name, "cam0");
    ASSERT_EQ(dataset.images.size(), 3U);
    EXPECT_EQ(dataset.images[1].t_ns, 1403636579813555584);
    EXPECT_EQ(dataset.images[1].listed_at, (folder.path() / "mav0/cam0/data.csv:3").string());
    const PinholeCamera& pinhole = dataset.camera.pinhole();
    EXPECT_EQ(pinhole.width_px, 752);
    EXPECT_EQ(pinhole.fy_px, 457.296);
    EXPECT_EQ(pinhole.cx_px, 367.215);
    const Distortion& lens = dataset.camera.distortion();
    EXPECT_EQ(lens.model, DistortionModel::kRadtan);
    EXPECT_EQ(lens.k[3], 1.76187114e-05);
    EXPECT_EQ(lens.k[4], 0.0);
    ASSERT_TRUE(dataset.T_body_camera.has_value());
    EXPECT_EQ(dataset.T_body_camera->translation.x(), -0.0216401454975);
    EXPECT_NEAR(dataset.T_body_camera->matrix()(1, 0), 0.999557249008, 1e-9);
    EXPECT_TRUE(read_frame(dataset, 2).ok());
  }
}

TEST(EurocLayout, TakesAZeroRadialLensForAPinhole) {
  const TemporaryFolder folder;
  testing::write_euroc(folder.path());
  change(folder.path() / "mav0/cam0/sensor.yaml",
         "-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05",
         "0, 0, 0, 0");
  EXPECT_TRUE(opened(options_of(folder.path())).camera.distortion().none());
}

TEST(EurocLayout, SaysWhatIsBroken) {
  const std::string list = "mav0/cam0/data.csv";
  const std::string sensor = "mav0/cam0/sensor.yaml";
  expect_told(
      testing::write_euroc,
      {{list, "1403636579813555584,", "nan,", "'nan': must be a whole number of nanoseconds"},
       {list, "1403636579813555584.png", "7.png", "7.png: no such file"},
       {list, "1403636579813555584,", "", "data.csv:3: 1 columns: must be 2"},
       {sensor, "intrinsics", "intrinsic", "sensor.yaml: intrinsics: is missing"},
       {sensor, "[458.654, ", "[", "3 numbers: must be 4"},
       {sensor, "458.654", "nan", "sensor.yaml:18: intrinsics: "},
       {sensor, "458.654", "nan", "'nan' must be a finite number"},
       {sensor, "752, 480", "752.5, 480", "must be whole numbers in [1, 65536]"},
       {sensor, "camera_model: pinhole", "camera_model: omni", "omni: must be pinhole"},
       {sensor, "radial-tangential", "double-sphere", "must be radial-tangential, equidistant"},
       {sensor, "-0.28340811, ", "", "3 numbers: must be 4 to 5"},
       {sensor, "0.999557249008", "0.9", "T_BS must be a rigid transform"}});
  const TemporaryFolder folder;
  testing::write_euroc(folder.path());
  DatasetOptions other = options_of(folder.path());
  other.camera_name = "cam1";
  EXPECT_THAT(error_of(other), HasSubstr("cam1/data.csv: no such file"));
  // A client's text must not lead out of the folder.
  other.camera_name = "../../etc";
  EXPECT_THAT(error_of(other), HasSubstr("camera name = \"../../etc\": must be"));
  fs::remove(folder.path() / sensor);
  EXPECT_THAT(error_of(options_of(folder.path())), HasSubstr("sensor.yaml: no such file"));
}

TEST(TumMonoLayout, IsReadWithItsRelativeCalibration) {
  const TemporaryFolder folder;
  testing::write_tum_mono(folder.path());
  const Dataset dataset = opened(options_of(folder.path()));
  EXPECT_EQ(dataset.layout, DatasetLayout::kTumMono);
  ASSERT_EQ(dataset.images.size(), 3U);
  EXPECT_EQ(dataset.images[1].exposure_ns, 5'250'000);
  EXPECT_EQ(dataset.images[2].index, 2);
  EXPECT_EQ(dataset.images[2].t_ns, 1'464'871'434'080'000'000);
  const PinholeCamera& pinhole = dataset.camera.pinhole();
  EXPECT_NEAR(pinhole.fx_px, 446.91584, 1e-9);
  EXPECT_NEAR(pinhole.cx_px, 0.49314 * 1280 - 0.5, 1e-9);
  EXPECT_NEAR(pinhole.cy_px, 0.499021 * 1024 - 0.5, 1e-9);
  EXPECT_EQ(dataset.camera.distortion().model, DistortionModel::kFov);
  EXPECT_EQ(dataset.camera.distortion().k[0], 0.6);
  ASSERT_EQ(dataset.notes.size(), 1U);
  EXPECT_THAT(dataset.notes.front(), HasSubstr("pcalib.txt is not applied"));
}

TEST(TumMonoLayout, ReadsEveryModelOfItsCalibration) {
  const TemporaryFolder folder;
  testing::write_tum_mono(folder.path());
  const auto camera = [&](const std::string& line) {
    write_text(folder.path() / "camera.txt", line + "\n1280 1024\nnone\n1280 1024\n");
    return opened(options_of(folder.path())).camera;
  };
  EXPECT_TRUE(camera("Pinhole 700 701 639.5 511.5 0").distortion().none());
  // Absolute values are taken as they are.
  EXPECT_EQ(camera("Pinhole 700 701 639.5 511.5 0").pinhole().cx_px, 639.5);
  EXPECT_TRUE(camera("0.5 0.6 0.5 0.5 0").distortion().none());
  EXPECT_EQ(camera("RadTan 700 701 639.5 511.5 -0.1 0.01 0.002 0.001").distortion().k[2], 0.002);
  EXPECT_EQ(camera("EquiDistant 700 701 639.5 511.5 0.1 0.01 0 0").distortion().model,
            DistortionModel::kEquidistant);
  EXPECT_EQ(camera("KannalaBrandt 700 701 639.5 511.5 0.1 0.01 0 0").distortion().model,
            DistortionModel::kEquidistant);
}

// The wide lens of the public sequences: its corners are more than 90 deg off the axis.
TEST(TumMonoLayout, KeepsItsCalibrationNextToAnotherCamera) {
  const TemporaryFolder folder;
  testing::write_tum_mono(folder.path());
  DatasetOptions options = options_of(folder.path());
  options.camera = CameraModel(PinholeCamera{1280, 1024, 700, 700, 639.5, 511.5});
  const Dataset dataset = opened(options);
  EXPECT_EQ(dataset.camera.pinhole().fx_px, 700.0);
  ASSERT_TRUE(dataset.own_camera.has_value());
  EXPECT_NEAR(dataset.own_camera->pinhole().fx_px, 446.91584, 1e-9);
  // A camera that is given replaces a calibration that cannot be read.
  write_text(folder.path() / "camera.txt", "Omni 1 2 3\n");
  EXPECT_FALSE(opened(options).own_camera.has_value());
}

TEST(TumMonoLayout, RefusesALensWhoseCornersSeeBackwards) {
  const TemporaryFolder folder;
  testing::write_tum_mono(folder.path());
  change(folder.path() / "camera.txt", " 0.6\n", " 0.933271\n");
  EXPECT_THAT(error_of(options_of(folder.path())),
              HasSubstr("camera.txt:1: distortion fov: folds the image before its corner"));
}

TEST(TumMonoLayout, SaysWhatIsBroken) {
  expect_told(testing::write_tum_mono,
              {{"times.txt", "00001 ", "00007 ", "times.txt:2: column 1 = '00007': no image"},
               {"times.txt", "00001 1464871434.0400 5.25\n", "", "2 times, but"},
               {"times.txt", " 5.25", " 5.25 7", "times.txt:2: 4 columns"},
               {"camera.txt", "0.349153000000000", "nan", "camera.txt:1: column 1"},
               {"camera.txt", "0.349153000000000", "Omni 0.3", "camera.txt:1: column 1 = 'Omni'"},
               {"camera.txt", "1280 1024", "1280", "camera.txt:2: 1 columns: must be 2"},
               {"camera.txt", "1280 1024", "1280 -1", "camera.txt:2: column 2 = '-1'"},
               {"camera.txt",
                "0.349153000000000",
                "Pinhole 0.3",
                "a Pinhole must have only coefficients of 0"}});
  const TemporaryFolder folder;
  testing::write_tum_mono(folder.path());
  fs::rename(folder.path() / "images", folder.path() / "images.zip");
  EXPECT_THAT(error_of(options_of(folder.path())), HasSubstr("unpack images.zip"));
}

TEST(TumRgbdLayout, NeedsACamera) {
  const TemporaryFolder folder;
  testing::write_tum_rgbd(folder.path());
  DatasetOptions options = options_of(folder.path());
  EXPECT_THAT(error_of(options), HasSubstr("layout tum-rgbd contains no calibration"));
  options.camera = CameraModel(PinholeCamera{0, 0, 20, 20, 7.5, 5.5});
  const Dataset dataset = opened(options);
  EXPECT_EQ(dataset.layout, DatasetLayout::kTumRgbd);
  ASSERT_EQ(dataset.images.size(), 3U);
  EXPECT_EQ(dataset.images[2].t_ns, 1'305'031'102'175'302'000);
  change(folder.path() / "rgb.txt", "rgb/1305031102.175301.png", "rgb/none.png");
  EXPECT_THAT(error_of(options), HasSubstr("rgb.txt:4: "));
}

TEST(KittiLayout, IsReadWithTheCalibrationOfItsCamera) {
  const TemporaryFolder folder;
  testing::write_kitti(folder.path());
  const Dataset grey = opened(options_of(folder.path()));
  EXPECT_EQ(grey.layout, DatasetLayout::kKitti);
  EXPECT_EQ(grey.camera_name, "image_0");
  EXPECT_EQ(grey.images[1].t_ns, 103'787'500);
  EXPECT_EQ(grey.camera.pinhole().fx_px, 718.856);
  EXPECT_EQ(grey.camera.pinhole().width_px, 1241);
  DatasetOptions options = options_of(folder.path());
  options.camera_name = "image_2";
  const Dataset colour = opened(options);
  EXPECT_EQ(colour.camera.pinhole().cx_px, 601.8873);
  EXPECT_TRUE(grey.T_first_camera->translation.isZero());
  // 6 cm left of image_0's camera.
  EXPECT_LT(
      (colour.T_first_camera->translation - Eigen::Vector3d(-0.06103, 0.00144, -0.00620)).norm(),
      1e-5);
  EXPECT_NE(read_frame(colour, 0)->image_crc32, read_frame(grey, 0)->image_crc32);
}

TEST(KittiLayout, SaysWhatIsBroken) {
  expect_told(testing::write_kitti,
              {{"times.txt", "2.073579e-01\n", "", "2 times, but"},
               {"times.txt", "2.073579e-01", "x", "times.txt:3: column 1 = 'x'"},
               {"calib.txt", "P0:", "Q0:", "calib.txt: contains no line P0:"},
               {"calib.txt", "7.188560000000e+02", "nan", "calib.txt:1: column 2"},
               {"calib.txt", " 7.188560000000e+02", "", "calib.txt:1: 12 columns: must be 13"},
               {"calib.txt", "0.000000000000e+00", "0.1", "calib.txt:1: must be [fx 0 cx a;"}});
  const TemporaryFolder folder;
  testing::write_kitti(folder.path());
  fs::remove(folder.path() / "image_0" / "000001.png");
  EXPECT_THAT(error_of(options_of(folder.path())), HasSubstr("contains 2 images"));
}

TEST(Layouts, UnknownFoldersAreToldWhatIsKnown) {
  const TemporaryFolder folder;
  const std::string message = error_of(options_of(folder.path()));
  for (const char* name : {"EuRoC", "TUM monoVO", "TUM RGB-D", "KITTI", "PNG + CSV"}) {
    EXPECT_THAT(message, HasSubstr(name));
  }
}

}  // namespace
}  // namespace overfly::server
