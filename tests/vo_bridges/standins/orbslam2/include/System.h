// A stand-in for ORB-SLAM2 with the interface that the adapter uses: written for its test, knows
// the camera's path (flown_path.hpp), takes its orders from the frames' first pixel.
#pragma once

#include <opencv2/core/core.hpp>
#include <string>
#include <vector>

#include "FrameDrawer.h"
#include "LocalMapping.h"
#include "LoopClosing.h"
#include "Map.h"
#include "Tracking.h"

namespace ORB_SLAM2 {

class MapPoint;

class System {
 public:
  enum eSensor { MONOCULAR = 0, STEREO = 1, RGBD = 2 };

  System(const std::string& vocabulary,
         const std::string& settings,
         eSensor sensor,
         bool use_viewer = true);
  cv::Mat TrackMonocular(const cv::Mat& image, const double& timestamp);
  bool MapChanged();
  void Reset() { mbReset = true; }
  int GetTrackingState() { return mpTracker->mState; }
  std::vector<MapPoint*> GetTrackedMapPoints() { return points_; }
  std::vector<cv::KeyPoint> GetTrackedKeyPointsUn() { return std::vector<cv::KeyPoint>(300); }

 private:
  void reset_now();
  void see_nothing();
  void see(const cv::Mat& Tcw);
  cv::Mat pose_at(double t_s) const;

  Map* mpMap;
  Tracking* mpTracker;
  LocalMapping* mpLocalMapper;
  LoopClosing* mpLoopCloser;
  FrameDrawer* mpFrameDrawer;
  bool mbReset = false;
  int known_changes_ = 0;
  std::vector<MapPoint*> points_;
};

}  // namespace ORB_SLAM2
