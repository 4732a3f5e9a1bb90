#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "MapPoint.h"
#include "System.h"
#include "tests/vo_bridges/standins/flown_path.hpp"

namespace ORB_SLAM2 {

void LoopClosing::InsertKeyFrame(long unsigned int id) {
  if (id < __atomic_load_n(&mLastLoopKFid, __ATOMIC_ACQUIRE) + 10) {
    ++in_database_;
    return;
  }
  ++map_->big_changes;
  __atomic_store_n(&mLastLoopKFid, id, __ATOMIC_RELEASE);
}

void LoopClosing::RequestReset() {
  __atomic_store_n(&mLastLoopKFid, 0UL, __ATOMIC_RELEASE);
  in_database_ = 0;
}

void LocalMapping::Run() {
  for (;;) {
    long unsigned int id = 0;
    bool taken = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      accepts_ = queue_.empty();
      if (!queue_.empty()) {
        id = queue_.front();
        queue_.pop_front();
        taken = true;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (!taken) continue;
    ++map_->keyframes;
    loop_closer_->InsertKeyFrame(id);
    const std::lock_guard<std::mutex> lock(mutex_);
    accepts_ = true;
  }
}

void LocalMapping::InsertKeyFrame(long unsigned int id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  queue_.push_back(id);
}

bool LocalMapping::AcceptKeyFrames() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return accepts_;
}

int LocalMapping::KeyframesInQueue() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(queue_.size());
}

void LocalMapping::RequestReset() {
  while (KeyframesInQueue() > 0 || !AcceptKeyFrames()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

cv::Mat FrameDrawer::DrawFrame() {
  cv::Mat drawn(last.rows + 20, last.cols, CV_8UC3, cv::Scalar(200, 100, 50));
  return drawn;
}

System::System(const std::string& vocabulary, const std::string& settings, eSensor, bool) {
  if (!std::ifstream(vocabulary)) std::exit(-1);
  const cv::FileStorage file(settings, cv::FileStorage::READ);
  if (!file.isOpened()) std::exit(-1);
  int min_threshold = static_cast<int>(file["ORBextractor.minThFAST"]);
  if (std::getenv("STANDIN_KEEPS_ITS_DEFAULT") != nullptr) min_threshold = 7;
  mpTracker = new Tracking(new ORBextractor(static_cast<int>(file["ORBextractor.nFeatures"]),
                                            static_cast<float>(file["ORBextractor.scaleFactor"]),
                                            static_cast<int>(file["ORBextractor.nLevels"]),
                                            static_cast<int>(file["ORBextractor.iniThFAST"]),
                                            min_threshold));
  mpMap = new Map;
  mpLoopCloser = new LoopClosing(mpMap);
  mpLocalMapper = new LocalMapping(mpMap, mpLoopCloser);
  mpFrameDrawer = new FrameDrawer;
  new std::thread(&LocalMapping::Run, mpLocalMapper);
}

bool System::MapChanged() {
  const bool changed = known_changes_ < mpMap->big_changes;
  known_changes_ = mpMap->big_changes;
  return changed;
}

void System::reset_now() {
  mpLocalMapper->RequestReset();
  mpLoopCloser->RequestReset();
  mpMap->keyframes = 0;
  mpTracker->mState = Tracking::NO_IMAGES_YET;
  mpTracker->since_start = 0;
  mpTracker->next_keyframe = 0;
  mbReset = false;
}

/// Camera from world; off by a step for each loop that was closed.
cv::Mat System::pose_at(double t_s) const {
  const Eigen::Matrix3d R = standins::orientation_at(t_s).toRotationMatrix().transpose();
  const Eigen::Vector3d t = -R * standins::position_at(t_s);
  cv::Mat Tcw = cv::Mat::eye(4, 4, CV_32F);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      Tcw.at<float>(row, column) = static_cast<float>(R(row, column));
    }
    Tcw.at<float>(row, 3) = static_cast<float>(t[row] + 5.0 * mpMap->big_changes);
  }
  return Tcw;
}

void System::see_nothing() {
  if (mpTracker->mState != Tracking::OK) return;
  mpTracker->mState = Tracking::LOST;
  if (mpTracker->next_keyframe <= 5) Reset();
}

void System::see(const cv::Mat& Tcw) {
  for (MapPoint* point : points_) delete point;
  points_.assign(1, nullptr);  // upstream's list has gaps
  const cv::Mat T_vo_camera = Tcw.inv();
  for (int i = -20; i <= 20; ++i) {
    const cv::Mat p_camera =
        (cv::Mat_<float>(4, 1) << 0.01F * static_cast<float>(i), 0.2F, standins::kDepth, 1.0F);
    points_.push_back(new MapPoint(cv::Mat(T_vo_camera * p_camera).rowRange(0, 3).clone()));
  }
}

cv::Mat System::TrackMonocular(const cv::Mat& image, const double& timestamp) {
  if (mbReset) reset_now();
  mpFrameDrawer->last = image;
  Tracking& tracker = *mpTracker;
  const int order = image.at<unsigned char>(0, 0);
  if (order == standins::kExit) std::exit(3);
  if (order == standins::kAbort) std::abort();
  if (order == standins::kDark) {
    see_nothing();
    return cv::Mat();
  }
  if (order == standins::kThrowMapAway) {
    tracker.mState = Tracking::LOST;
    Reset();
    return cv::Mat();
  }
  if (tracker.mState == Tracking::LOST && mpLoopCloser->in_database() == 0) return cv::Mat();
  if (tracker.mState != Tracking::LOST && ++tracker.since_start < 3) {
    tracker.mState = Tracking::NOT_INITIALIZED;
    return cv::Mat();
  }
  tracker.mState = Tracking::OK;
  mpLocalMapper->InsertKeyFrame(tracker.next_keyframe++);
  const cv::Mat Tcw = pose_at(timestamp);
  see(Tcw);
  return Tcw;
}

}  // namespace ORB_SLAM2
