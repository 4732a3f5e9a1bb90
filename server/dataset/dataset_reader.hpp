// Internal to dataset: the readers of each layout, and what they share.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/text/text_fields.hpp"
#include "server/dataset/dataset.hpp"

namespace overfly::server {

/// A data set whose images are listed; a camera of size 0 x 0 px is not known yet.
struct ListedDataset {
  Dataset dataset;
  std::optional<CameraModel> camera;
};

[[nodiscard]] Result<ListedDataset> read_plain_folder(const DatasetOptions& options);
[[nodiscard]] Result<ListedDataset> read_euroc(const DatasetOptions& options);
[[nodiscard]] Result<ListedDataset> read_tum_mono(const DatasetOptions& options);
[[nodiscard]] Result<ListedDataset> read_tum_rgbd(const DatasetOptions& options);
[[nodiscard]] Result<ListedDataset> read_kitti(const DatasetOptions& options);
[[nodiscard]] Result<ListedDataset> read_png_export(const DatasetOptions& options);

/// The folder that holds `mav0/cam0` or another layout that EuRoC's reader accepts; empty if there
/// is none.
[[nodiscard]] std::optional<std::filesystem::path> euroc_cameras_folder(
    const std::filesystem::path& folder);
/// KITTI's image folder: "image_0", else the first of the others that exists.
[[nodiscard]] std::optional<std::string> kitti_image_folder(const std::filesystem::path& folder);

/// Calibration files. Errors: kUnreadable naming file, line and value.
struct EurocSensor {
  CameraModel camera;
  Pose T_body_camera;
};
[[nodiscard]] Result<EurocSensor> read_euroc_sensor(const std::filesystem::path& file);
/// Follows DSO: the values are relative if cx and cy are below 1; half a pixel is then subtracted
/// from both.
[[nodiscard]] Result<CameraModel> read_tum_mono_camera(const std::filesystem::path& file);

/// Errors: kInvalidArgument for a name that would lead out of the data set's folder.
[[nodiscard]] Status check_camera_name(const std::string& name);

/// Appends an image. Whether its file exists is checked later.
[[nodiscard]] Status append_image(const std::filesystem::path& list_file,
                                  const FieldLine& line,
                                  DatasetImage image,
                                  std::vector<DatasetImage>& images);
/// Sorts the listed images by time; of images with the same time the first is kept. If images were
/// reordered, all are renumbered.
/// Errors: kUnreadable, naming the line, for images whose own numbers do not increase.
[[nodiscard]] Status order_images(Dataset& dataset);

/// Exposure in milliseconds, 0 = not known. Errors: kUnreadable, also for a negative value.
[[nodiscard]] Result<std::int64_t> exposure_ms(const FieldFile& list,
                                               const FieldLine& line,
                                               std::size_t column);

/// The images in a folder, sorted with numbers in names compared as numbers. Errors: kNotFound.
[[nodiscard]] Result<std::vector<std::filesystem::path>> images_in(
    const std::filesystem::path& folder);

/// Checks that image count and line count are equal. Errors: kUnreadable with both counts.
[[nodiscard]] Status expect_as_many(const std::filesystem::path& list_file,
                                    std::size_t lines,
                                    const std::filesystem::path& folder,
                                    std::size_t images);

}  // namespace overfly::server
