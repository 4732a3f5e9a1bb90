#include "server/dataset/dataset.hpp"

#include <array>

namespace overfly::server {
namespace {

constexpr std::array<DatasetLayout, 6> kLayouts{DatasetLayout::kImages,
                                                DatasetLayout::kEuroc,
                                                DatasetLayout::kTumMono,
                                                DatasetLayout::kTumRgbd,
                                                DatasetLayout::kKitti,
                                                DatasetLayout::kPng};

}  // namespace

const char* to_string(DatasetLayout layout) {
  switch (layout) {
    case DatasetLayout::kEuroc:
      return "euroc";
    case DatasetLayout::kTumMono:
      return "tum-mono";
    case DatasetLayout::kTumRgbd:
      return "tum-rgbd";
    case DatasetLayout::kKitti:
      return "kitti";
    case DatasetLayout::kPng:
      return "png";
    case DatasetLayout::kImages:
      break;
  }
  return "images";
}

std::optional<DatasetLayout> dataset_layout_from(const std::string& text) {
  for (const DatasetLayout layout : kLayouts) {
    if (text == to_string(layout)) return layout;
  }
  return std::nullopt;
}

}  // namespace overfly::server
