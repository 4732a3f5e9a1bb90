#include "tests/server/dataset/dataset_fixture.hpp"
#include "server/dataset/open_dataset.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace overfly::server::testing {

namespace fs = std::filesystem;
using overfly::testing::write_text;

void write_image(const fs::path& file, int seed, int width_px, int height_px) {
  fs::create_directories(file.parent_path());
  cv::Mat image(height_px, width_px, CV_8UC1);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(7 * x + 13 * y + 31 * seed);
    }
  }
  if (!cv::imwrite(file.string(), image)) throw std::runtime_error("cannot write " + file.string());
}

void write_images(const fs::path& folder, int count) {
  for (int i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    write_image(folder / (std::string(5 - number.size(), '0') + number + ".png"), i);
  }
}

DatasetOptions plain_options(const fs::path& folder) {
  DatasetOptions options;
  options.folder = folder / "images";
  options.times = folder / "times.txt";
  options.camera = CameraModel(PinholeCamera{0, 0, 20, 20, 7.5, 5.5});
  return options;
}

std::string error_of(const DatasetOptions& options) {
  const Result<Dataset> dataset = open_dataset(options);
  if (!dataset) return dataset.error().message;
  ADD_FAILURE() << "opened, but should not";
  return "";
}

void write_euroc(const fs::path& folder) {
  const fs::path camera = folder / "mav0" / "cam0";
  std::string list = "#timestamp [ns],filename\r\n";
  for (int i = 0; i < 3; ++i) {
    const std::string stamp = std::to_string(1403636579763555584 + 50'000'000LL * i);
    write_image(camera / "data" / (stamp + ".png"), i, 752, 480);
    list += stamp + "," + stamp + ".png\r\n";
  }
  write_text(camera / "data.csv", list);
  write_text(camera / "sensor.yaml",
             "# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor cam0\n\n"
             "# Sensor extrinsics wrt. the body-frame.\nT_BS:\n  cols: 4\n  rows: 4\n"
             "  data: [0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,\n"
             "         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,\n"
             "        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,\n"
             "         0.0, 0.0, 0.0, 1.0]\n\n# Camera specific definitions.\nrate_hz: 20\n"
             "resolution: [752, 480]\ncamera_model: pinhole\n"
             "intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n"
             "distortion_model: radial-tangential\n"
             "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n");
}

void write_tum_mono(const fs::path& folder) {
  for (int i = 0; i < 3; ++i) {
    write_image(folder / "images" / ("0000" + std::to_string(i) + ".jpg"), i, 1280, 1024);
  }
  write_text(folder / "times.txt",
             "00000 1464871434.0000 5.0\n00001 1464871434.0400 5.25\n00002 1464871434.0800 0\n");
  write_text(folder / "camera.txt",
             "0.349153000000000 0.436593000000000 0.493140000000000 0.499021000000000 "
             "0.6\n1280 1024\ncrop\n640 480\n");
  write_text(folder / "pcalib.txt", "0 1 2\n");
}

void write_tum_rgbd(const fs::path& folder) {
  std::string list = "# color images\n# timestamp filename\n";
  for (int i = 0; i < 3; ++i) {
    const std::string stamp = "1305031102.17530" + std::to_string(i);
    write_image(folder / "rgb" / (stamp + ".png"), i);
    list += stamp + " rgb/" + stamp + ".png\n";
  }
  write_text(folder / "rgb.txt", list);
}

void write_kitti(const fs::path& folder) {
  for (int i = 0; i < 3; ++i) {
    write_image(folder / "image_0" / ("00000" + std::to_string(i) + ".png"), i, 1241, 376);
    write_image(folder / "image_2" / ("00000" + std::to_string(i) + ".png"), i + 9, 1241, 376);
  }
  write_text(folder / "times.txt", "0.000000e+00\n1.037875e-01\n2.073579e-01\n");
  write_text(folder / "calib.txt",
             "P0: 7.188560000000e+02 0.000000000000e+00 6.071928000000e+02 0.000000000000e+00 "
             "0.000000000000e+00 7.188560000000e+02 1.852157000000e+02 0.000000000000e+00 "
             "0.000000000000e+00 0.000000000000e+00 1.000000000000e+00 0.000000000000e+00\n"
             "P2: 7.070912000000e+02 0.000000000000e+00 6.018873000000e+02 4.688783000000e+01 "
             "0.000000000000e+00 7.070912000000e+02 1.831104000000e+02 1.178601000000e-01 "
             "0.000000000000e+00 0.000000000000e+00 1.000000000000e+00 6.203223000000e-03\n");
}

}  // namespace overfly::server::testing
