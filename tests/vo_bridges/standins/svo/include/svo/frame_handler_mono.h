// A stand-in for SVO with the interface that the adapter uses: written for its test, knows the
// camera's path (flown_path.hpp), takes its orders from the frames' first pixel.
#pragma once

#include <vikit/pinhole_camera.h>

#include <opencv2/core/core.hpp>
#include <vector>

#include "depth_filter.h"
#include "frame.h"
#include "map.h"

namespace svo {

class FrameHandlerBase {
 public:
  enum Stage {
    STAGE_PAUSED,
    STAGE_FIRST_FRAME,
    STAGE_SECOND_FRAME,
    STAGE_DEFAULT_FRAME,
    STAGE_RELOCALIZING
  };
  const Map& map() const { return map_; }
  void start() { set_start_ = true; }
  Stage stage() const { return stage_; }
  /// One less with the depth filter in its thread, so that a test sees it.
  std::size_t lastNumObservations() const { return depth_filter_.in_thread ? 119 : 120; }

 protected:
  Stage stage_ = STAGE_PAUSED;
  bool set_start_ = false;
  Map map_;
  DepthFilter depth_filter_;
};

class FrameHandlerMono : public FrameHandlerBase {
 public:
  explicit FrameHandlerMono(vk::AbstractCamera* camera);
  void addImage(const cv::Mat& image, double timestamp);
  FramePtr lastFrame() { return last_frame_; }
  FramePtr lastFrame() const { return last_frame_; }
  DepthFilter* depthFilter() { return &depth_filter_; }
  const std::vector<cv::Point2f>& initFeatureTrackCurPx() const { return tracks_; }

 private:
  void see(double t_s);

  vk::PinholeCamera camera_;
  FramePtr last_frame_;
  std::vector<cv::Point2f> tracks_;
};

}  // namespace svo
