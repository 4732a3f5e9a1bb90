#include "server/dataset/open_dataset.hpp"

#include <memory>
#include <system_error>
#include <utility>

#include "core/measure/crc32.hpp"
#include "server/dataset/dataset_reader.hpp"
#include "server/dataset/grey_image.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Detects the layout by files that only this layout has.
Result<DatasetLayout> layout_of(const fs::path& folder) {
  const auto has = [&](const char* name) {
    std::error_code ignored;
    return fs::exists(folder / name, ignored);
  };
  if (euroc_cameras_folder(folder)) return DatasetLayout::kEuroc;
  if (has("cameras.json")) return DatasetLayout::kPng;
  if (has("rgb.txt")) return DatasetLayout::kTumRgbd;
  if (has("times.txt") && kitti_image_folder(folder)) return DatasetLayout::kKitti;
  if (has("times.txt") && (has("images") || has("images.zip"))) return DatasetLayout::kTumMono;
  return Error{ErrorCode::kInvalidArgument,
               folder.string() +
                   ": no data set of a known layout (EuRoC: mav0/cam0/data.csv; TUM monoVO: "
                   "times.txt and images/; TUM RGB-D: rgb.txt; KITTI: times.txt and image_0/; "
                   "PNG + CSV: cameras.json); a folder of images needs a times file"};
}

Result<ListedDataset> read_layout(DatasetLayout layout, const DatasetOptions& options) {
  switch (layout) {
    case DatasetLayout::kEuroc:
      return read_euroc(options);
    case DatasetLayout::kTumMono:
      return read_tum_mono(options);
    case DatasetLayout::kTumRgbd:
      return read_tum_rgbd(options);
    case DatasetLayout::kKitti:
      return read_kitti(options);
    case DatasetLayout::kPng:
      return read_png_export(options);
    case DatasetLayout::kImages:
      break;
  }
  if (!options.times) {
    return Error{ErrorCode::kInvalidArgument,
                 options.folder.string() + ": a folder of images needs a times file"};
  }
  return read_plain_folder(options);
}

Status check_options(const DatasetOptions& options) {
  std::error_code ignored;
  if (!fs::is_directory(options.folder, ignored)) {
    return Error{ErrorCode::kNotFound, options.folder.string() + ": no such folder"};
  }
  if (options.sample_bits < 8 || options.sample_bits > 16) {
    return Error{ErrorCode::kInvalidArgument,
                 "sample bits = " + std::to_string(options.sample_bits) + ": must be in [8, 16]"};
  }
  if (options.times && options.layout.value_or(DatasetLayout::kImages) != DatasetLayout::kImages) {
    return Error{ErrorCode::kInvalidArgument,
                 "a times file is only for a plain folder of images, not for layout " +
                     std::string(to_string(*options.layout))};
  }
  return {};
}

std::string size_text(int width_px, int height_px) {
  return std::to_string(width_px) + " x " + std::to_string(height_px) + " px";
}

/// The given calibration, else the data set's own; a missing size is taken from the first image.
Result<CameraModel> choose_camera(const DatasetOptions& options, const ListedDataset& listed) {
  if (!options.camera && !listed.camera) {
    return Error{ErrorCode::kInvalidArgument,
                 options.folder.string() + ": layout " + to_string(listed.dataset.layout) +
                     " contains no calibration: the camera must be given"};
  }
  const CameraModel& known = options.camera ? *options.camera : *listed.camera;
  if (options.list_only) return known;
  PinholeCamera pinhole = known.pinhole();
  const DatasetImage& first = listed.dataset.images.front();
  const Result<Image> image = read_grey_image(first.file, options.sample_bits);
  if (!image) return image.error().in(first.listed_at);
  if (pinhole.width_px == 0 && pinhole.height_px == 0) {
    pinhole.width_px = image->width_px;
    pinhole.height_px = image->height_px;
  }
  const CameraModel camera(pinhole, known.distortion());
  if (Status status = camera.validate(); !status) return status.error().in("camera");
  return camera;
}

Status check_files_exist(const std::vector<DatasetImage>& images) {
  for (const DatasetImage& image : images) {
    std::error_code ignored;
    if (fs::exists(image.file, ignored)) continue;
    return Error{ErrorCode::kNotFound,
                 image.listed_at + ": " + image.file.string() + ": no such file"};
  }
  return {};
}

}  // namespace

Result<Dataset> open_dataset(const DatasetOptions& options) {
  if (Status status = check_options(options); !status) return status.error();
  Result<DatasetLayout> layout = options.times    ? DatasetLayout::kImages
                                 : options.layout ? *options.layout
                                                  : layout_of(options.folder);
  if (!layout) return layout.error();
  Result<ListedDataset> listed = read_layout(*layout, options);
  if (!listed) return listed.error();
  Dataset& dataset = listed->dataset;
  dataset.folder = options.folder;
  dataset.sample_bits = options.sample_bits;
  if (dataset.images.empty()) {
    return Error{ErrorCode::kUnreadable, options.folder.string() + ": lists no images"};
  }
  if (!options.list_only) {
    if (Status status = check_files_exist(dataset.images); !status) return status.error();
  }
  if (Status status = order_images(dataset); !status) return status.error();
  const Result<CameraModel> camera = choose_camera(options, *listed);
  if (!camera) return camera.error();
  dataset.camera = *camera;
  dataset.own_camera = listed->camera;
  return std::move(dataset);
}

Result<VoFrame> read_frame(const Dataset& dataset, std::size_t i) {
  const DatasetImage& entry = dataset.images.at(i);
  Result<Image> image = read_grey_image(entry.file, dataset.sample_bits);
  if (!image) return image.error().in(entry.listed_at);
  const PinholeCamera& pinhole = dataset.camera.pinhole();
  if (image->width_px != pinhole.width_px || image->height_px != pinhole.height_px) {
    return Error{ErrorCode::kUnreadable,
                 entry.listed_at + ": " + entry.file.string() + ": " +
                     size_text(image->width_px, image->height_px) + ": must be " +
                     size_text(pinhole.width_px, pinhole.height_px) + " as the calibration"};
  }
  VoFrame frame;
  if (!dataset.camera_name.empty()) frame.camera_id = dataset.camera_name;
  frame.index = entry.index;
  frame.t_ns = entry.t_ns;
  frame.exposure_ns = entry.exposure_ns;
  frame.intrinsics = pinhole;
  frame.distortion = dataset.camera.distortion();
  frame.image_crc32 = crc32_of(*image);
  frame.image = std::make_shared<const Image>(std::move(*image));
  return frame;
}

}  // namespace overfly::server
