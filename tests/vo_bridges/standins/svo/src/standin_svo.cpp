#include <svo/config.h>
#include <svo/frame_handler_mono.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "tests/vo_bridges/standins/flown_path.hpp"

namespace svo {
namespace {

template <typename T, int kTag>
T& setting(T standard) {
  static T value = standard;
  return value;
}

/// What a library does that does not take a value: reads back its own.
double& stubborn(double& value) {
  static double own = 20.0;
  return std::getenv("STANDIN_KEEPS_ITS_DEFAULT") != nullptr ? (own = 20.0) : value;
}

}  // namespace

std::string& Config::traceName() { return setting<std::string, 18>("svo"); }
std::string& Config::traceDir() { return setting<std::string, 19>("/tmp"); }
std::size_t& Config::nPyrLevels() { return setting<std::size_t, 0>(3); }
std::size_t& Config::gridSize() { return setting<std::size_t, 1>(25); }
double& Config::initMinDisparity() { return setting<double, 2>(50.0); }
std::size_t& Config::initMinTracked() { return setting<std::size_t, 3>(50); }
std::size_t& Config::initMinInliers() { return setting<std::size_t, 4>(40); }
std::size_t& Config::kltMaxLevel() { return setting<std::size_t, 5>(4); }
std::size_t& Config::kltMinLevel() { return setting<std::size_t, 6>(2); }
double& Config::reprojThresh() { return setting<double, 7>(2.0); }
double& Config::poseOptimThresh() { return setting<double, 8>(2.0); }
std::size_t& Config::poseOptimNumIter() { return setting<std::size_t, 9>(10); }
std::size_t& Config::structureOptimMaxPts() { return setting<std::size_t, 10>(20); }
std::size_t& Config::structureOptimNumIter() { return setting<std::size_t, 11>(5); }
double& Config::kfSelectMinDist() { return setting<double, 12>(0.12); }
double& Config::triangMinCornerScore() { return stubborn(setting<double, 13>(20.0)); }
std::size_t& Config::maxNKfs() { return setting<std::size_t, 14>(0); }
std::size_t& Config::maxFts() { return setting<std::size_t, 15>(120); }
std::size_t& Config::qualityMinFts() { return setting<std::size_t, 16>(50); }
int& Config::qualityMaxFtsDrop() { return setting<int, 17>(40); }

FrameHandlerMono::FrameHandlerMono(vk::AbstractCamera* camera)
    : camera_(*static_cast<vk::PinholeCamera*>(camera)) {
  std::ofstream(Config::traceDir() + "/" + Config::traceName() + ".csv") << "tot_time\n";
}

/// Frame from world, and points in front of it.
void FrameHandlerMono::see(double t_s) {
  const Sophus::SE3 T_world_frame(standins::orientation_at(t_s), standins::position_at(t_s));
  last_frame_ = std::make_shared<Frame>();
  last_frame_->T_f_w_ = T_world_frame.inverse();
  for (int i = -20; i <= 20; ++i) {
    auto* feature = new Feature;
    feature->px = Eigen::Vector2d(camera_.cx + 2.0 * i, camera_.cy);
    feature->point = new Point(T_world_frame * Eigen::Vector3d(0.01 * i, 0.2, standins::kDepth));
    last_frame_->fts_.push_back(feature);
  }
  last_frame_->fts_.push_back(new Feature{Eigen::Vector2d(9.0, 9.0), nullptr});
}

void FrameHandlerMono::addImage(const cv::Mat& image, double timestamp) {
  if (image.cols != static_cast<int>(camera_.width)) {
    throw std::runtime_error("an image of another size");
  }
  if (set_start_) {
    set_start_ = false;
    map_.keyframes = 0;
    last_frame_.reset();
    stage_ = STAGE_FIRST_FRAME;
  }
  if (stage_ == STAGE_PAUSED) return;
  const int order = image.at<unsigned char>(0, 0);
  if (order == standins::kExit) std::exit(3);
  if (order == standins::kAbort) std::abort();
  const bool dark = order == standins::kDark;
  if (order == standins::kThrowMapAway || (dark && stage_ == STAGE_SECOND_FRAME)) {
    stage_ = STAGE_PAUSED;
    last_frame_.reset();
    return;
  }
  if (stage_ == STAGE_FIRST_FRAME) {
    stage_ = STAGE_SECOND_FRAME;
    tracks_.assign(5, cv::Point2f(20.0F, 20.0F));
    return;
  }
  if (dark) {
    stage_ = STAGE_RELOCALIZING;
    return;
  }
  stage_ = STAGE_DEFAULT_FRAME;
  ++map_.keyframes;
  see(timestamp);
}

}  // namespace svo
