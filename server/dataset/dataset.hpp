// Recorded images with their times and calibration, as others lay them out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace overfly::engine {

enum class DatasetLayout {
  kImages,   ///< a folder of images, times in a file of their own
  kEuroc,    ///< EuRoC ASL: mav0/cam0/data.csv, sensor.yaml
  kTumMono,  ///< TUM monoVO: images/, times.txt, camera.txt
  kTumRgbd,  ///< TUM RGB-D: rgb.txt
  kKitti,    ///< KITTI odometry: image_0/, times.txt, calib.txt
  kPng,      ///< `overfly export --format png`: cameras.json, CAMERA.csv
};

/// "images", "euroc", "tum-mono", "tum-rgbd", "kitti", "png".
[[nodiscard]] const char* to_string(DatasetLayout layout);
[[nodiscard]] std::optional<DatasetLayout> dataset_layout_from(const std::string& text);

enum class TimeUnit { kAuto, kSeconds, kNanoseconds };

struct DatasetImage {
  std::filesystem::path file;
  std::string listed_at;         ///< "FILE:LINE" that names it
  int line = 0;                  ///< that LINE
  std::int64_t index = 0;        ///< the data set's own number, else its line's place; increasing
  std::int64_t t_ns = 0;         ///< as the data set counts; increasing
  std::int64_t exposure_ns = 0;  ///< 0 = not known
};

struct Dataset {
  std::filesystem::path folder;
  DatasetLayout layout = DatasetLayout::kImages;
  std::string camera_name;           ///< "cam0", "image_0", ...; empty where there is but one
  std::vector<DatasetImage> images;  ///< at least one
  CameraModel camera;
  std::optional<Pose> T_body_camera;  ///< the mount: EuRoC's T_BS
  /// KITTI: this camera in that of image_0, whose poses its truth files hold.
  std::optional<Pose> T_first_camera;
  std::vector<std::string> notes;  ///< what a reader of results should know
  /// Images and poses of the truth that were left out or moved, with file, count and line.
  std::vector<std::string> warnings;
  int sample_bits = 16;  ///< of images with more than 8 bit a sample
};

struct DatasetOptions {
  std::filesystem::path folder;
  std::optional<DatasetLayout> layout;  ///< empty = told by the files that are there
  /// Times of the images of a plain folder, one a line: `TIME`, or the image's name beside it
  /// (`NAME TIME [EXPOSURE_MS]`, `TIME NAME`, `TIME,NAME`). Given, the folder is a plain one.
  std::optional<std::filesystem::path> times;
  TimeUnit time_unit = TimeUnit::kAuto;  ///< of `times`; auto: no frame lasts a day or 0.1 ms
  std::string camera_name;               ///< which of several; empty = the first
  /// In place of the data set's own; a size of 0 x 0 px is taken from the first image.
  std::optional<CameraModel> camera;
  int sample_bits = 16;  ///< of 16-bit files: values fill so many bits, in [8, 16]
};

}  // namespace overfly::engine
