// What the tests of recorded data sets share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/dataset/dataset.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::testing {

constexpr int kWidthPx = 16;
constexpr int kHeightPx = 12;

/// A small grey image, its values made of `seed`; written by OpenCV, format by the name's ending.
void write_image(const std::filesystem::path& file,
                 int seed = 0,
                 int width_px = kWidthPx,
                 int height_px = kHeightPx);

/// 00000.png, 00001.png, ... of the above.
void write_images(const std::filesystem::path& folder, int count);

/// Options of a plain folder: `images` and `times.txt` in `folder`, a camera of no size.
[[nodiscard]] DatasetOptions plain_options(const std::filesystem::path& folder);

/// The error of opening; fails the test where it opens.
[[nodiscard]] std::string error_of(const DatasetOptions& options);

// Small data sets, each of three images, with calibrations as the public ones have them.
void write_euroc(const std::filesystem::path& folder);
void write_tum_mono(const std::filesystem::path& folder);
void write_tum_rgbd(const std::filesystem::path& folder);
void write_kitti(const std::filesystem::path& folder);

}  // namespace overfly::server::testing
