// SVO's parameters with its library's defaults (its ROS node uses others: preset ros_fast), and its
// published variants.
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

std::string upstream_name() { return "SVO"; }

const ParameterSet& upstream_parameters() {
  static const ParameterSet set(
      {
          {"depth_filter_thread", ParameterKind::kAutoFlag, "auto", 0, 0},
          {"restart_when_paused", ParameterKind::kFlag, "true", 0, 0},
          {"nPyrLevels", ParameterKind::kWhole, "3", 1, 8},
          {"gridSize", ParameterKind::kWhole, "25", 5, 1000},
          {"initMinDisparity", ParameterKind::kNumber, "50", 0, 1000},
          {"initMinTracked", ParameterKind::kWhole, "50", 4, 10000},
          {"initMinInliers", ParameterKind::kWhole, "40", 4, 10000},
          {"kltMaxLevel", ParameterKind::kWhole, "4", 0, 8},
          {"kltMinLevel", ParameterKind::kWhole, "2", 0, 8},
          {"reprojThresh", ParameterKind::kNumber, "2", 0, 100},
          {"poseOptimThresh", ParameterKind::kNumber, "2", 0, 100},
          {"poseOptimNumIter", ParameterKind::kWhole, "10", 1, 1000},
          {"structureOptimMaxPts", ParameterKind::kWhole, "20", 0, 10000},
          {"structureOptimNumIter", ParameterKind::kWhole, "5", 0, 1000},
          {"kfSelectMinDist", ParameterKind::kNumber, "0.12", 0, 10},
          {"triangMinCornerScore", ParameterKind::kNumber, "20", 0, 1000},
          {"maxNKfs", ParameterKind::kWhole, "0", 0, 100000},
          {"maxFts", ParameterKind::kWhole, "120", 10, 10000},
          {"qualityMinFts", ParameterKind::kWhole, "50", 1, 10000},
          {"qualityMaxFtsDrop", ParameterKind::kWhole, "40", 1, 10000},
      },
      {
          {"triangMinCornerScore_20", {{"triangMinCornerScore", "20"}}, ""},
          {"triangMinCornerScore_7", {{"triangMinCornerScore", "7"}}, ""},
          {"triangMinCornerScore_2", {{"triangMinCornerScore", "2"}}, ""},
          {"kfSelectMinDist_12", {{"kfSelectMinDist", "0.12"}}, ""},
          {"kfSelectMinDist_5", {{"kfSelectMinDist", "0.05"}}, ""},
          {"ros_fast", {{"gridSize", "30"}, {"maxNKfs", "10"}}, ""},
          {"ros_accurate", {{"gridSize", "20"}, {"maxNKfs", "50"}, {"maxFts", "200"}}, ""},
      });
  return set;
}

}  // namespace overfly_adapters
