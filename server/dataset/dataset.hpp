// Recorded images with time stamps and calibration, in the layouts of common data sets.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"

namespace overfly::server {

enum class DatasetLayout {
  kImages,   ///< a folder of images, times in a separate file
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
  std::string listed_at;   ///< "FILE:LINE" of its entry
  int line = 0;            ///< LINE of listed_at
  std::int64_t index = 0;  ///< the data set's own number, else the position in the list; increasing
  std::int64_t t_ns = 0;   ///< in the data set's time base; increasing
  std::int64_t exposure_ns = 0;  ///< 0 = not known
};

struct Dataset {
  std::filesystem::path folder;
  DatasetLayout layout = DatasetLayout::kImages;
  std::string camera_name;           ///< "cam0", "image_0", ...; empty if there is only one
  std::vector<DatasetImage> images;  ///< at least one
  CameraModel camera;
  /// The data set's own calibration, also if another camera was given; KITTI's has no size.
  std::optional<CameraModel> own_camera;
  std::optional<Pose> T_body_camera;  ///< the mount: EuRoC's T_BS
  /// KITTI: pose of this camera in the frame of image_0, which the truth files use.
  std::optional<Pose> T_first_camera;
  std::vector<std::string> notes;  ///< facts that a reader of the results should know
  /// Images and truth poses that were left out or reordered, with file, count and line.
  std::vector<std::string> warnings;
  int sample_bits = 16;  ///< significant bits of samples deeper than 8 bit
};

struct DatasetOptions {
  std::filesystem::path folder;
  std::optional<DatasetLayout> layout;  ///< empty = detected from the files
  /// Times of the images of a plain folder, one a line: `TIME`, or with the image's name (`NAME
  /// TIME [EXPOSURE_MS]`, `TIME NAME`, `TIME,NAME`). If given, the layout is a plain folder.
  std::optional<std::filesystem::path> times;
  /// Of `times`; auto assumes frame periods between 0.1 ms and one day
  TimeUnit time_unit = TimeUnit::kAuto;
  std::string camera_name;  ///< selects one of several cameras; empty = the first
  /// Replaces the data set's calibration; a size of 0 x 0 px is taken from the first image.
  std::optional<CameraModel> camera;
  int sample_bits = 16;  ///< significant bits of 16-bit files, in [8, 16]
  /// Neither looks whether the listed files exist nor reads the first one. `camera` must be given,
  /// with its size.
  bool list_only = false;
};

}  // namespace overfly::server
