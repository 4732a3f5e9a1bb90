#pragma once

#include <cstddef>
#include <string>

namespace svo {

class Config {
 public:
  static std::string& traceName();
  static std::string& traceDir();
  static std::size_t& nPyrLevels();
  static std::size_t& gridSize();
  static double& initMinDisparity();
  static std::size_t& initMinTracked();
  static std::size_t& initMinInliers();
  static std::size_t& kltMaxLevel();
  static std::size_t& kltMinLevel();
  static double& reprojThresh();
  static double& poseOptimThresh();
  static std::size_t& poseOptimNumIter();
  static std::size_t& structureOptimMaxPts();
  static std::size_t& structureOptimNumIter();
  static double& kfSelectMinDist();
  static double& triangMinCornerScore();
  static std::size_t& maxNKfs();
  static std::size_t& maxFts();
  static std::size_t& qualityMinFts();
  static int& qualityMaxFtsDrop();
};

}  // namespace svo
