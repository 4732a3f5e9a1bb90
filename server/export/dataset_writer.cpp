#include "server/export/dataset_writer.hpp"

#include <system_error>

namespace overfly::server {

const char* to_string(DatasetFormat format) {
  switch (format) {
    case DatasetFormat::kTumMono:
      return "tum-mono";
    case DatasetFormat::kEuroc:
      return "euroc";
    case DatasetFormat::kKitti:
      return "kitti";
    case DatasetFormat::kLcm:
      return "lcm";
    case DatasetFormat::kRosbag:
      return "rosbag";
    case DatasetFormat::kMcap:
      return "mcap";
    case DatasetFormat::kPng:
      break;
  }
  return "png";
}

std::optional<DatasetFormat> dataset_format_from(const std::string& text) {
  for (const DatasetFormat format : {DatasetFormat::kTumMono,
                                     DatasetFormat::kEuroc,
                                     DatasetFormat::kKitti,
                                     DatasetFormat::kPng,
                                     DatasetFormat::kLcm,
                                     DatasetFormat::kRosbag,
                                     DatasetFormat::kMcap}) {
    if (text == to_string(format)) return format;
  }
  return std::nullopt;
}

Result<std::unique_ptr<DatasetWriter>> create_dataset_writer(DatasetFormat format,
                                                             const DatasetPlan& plan) {
  switch (format) {
    case DatasetFormat::kTumMono:
      return create_tum_mono_writer(plan);
    case DatasetFormat::kEuroc:
      return create_euroc_writer(plan);
    case DatasetFormat::kKitti:
      return create_kitti_writer(plan);
    case DatasetFormat::kLcm:
      return create_lcm_writer(plan);
    case DatasetFormat::kRosbag:
      return create_rosbag_writer(plan);
    case DatasetFormat::kMcap:
      return create_mcap_writer(plan);
    case DatasetFormat::kPng:
      break;
  }
  return create_png_writer(plan);
}

Status make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!failure) return {};
  return Error{ErrorCode::kIo, folder.string() + ": cannot be created: " + failure.message()};
}

}  // namespace overfly::server
