// Collects what DSO publishes about the current frame. C++11.
#pragma once

#include <FullSystem/FullSystem.h>
#include <FullSystem/HessianBlocks.h>
#include <IOWrapper/Output3DWrapper.h>
#include <util/FrameShell.h>

#include <mutex>
#include <vector>

namespace overfly_adapters {

using Points = std::vector<Eigen::Vector3d, Eigen::aligned_allocator<Eigen::Vector3d>>;

/// Receives poses and points. In real time DSO's mapping publishes from its own thread.
class DsoPublications : public dso::IOWrap::Output3DWrapper {
 public:
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW

  /// From now on accepts data of the frame with this identifier.
  void begin_frame(int id);

  void publishCamPose(dso::FrameShell* frame, dso::CalibHessian* calibration) override;
  void publishKeyframes(std::vector<dso::FrameHessian*>& frames,
                        bool final,
                        dso::CalibHessian* calibration) override;

  /// Pose of the current frame; returns false if there is none. `refined`: as refined by mapping,
  /// valid only while no mapping runs; otherwise as tracked.
  bool pose(bool refined, dso::SE3* T_vo_camera) const;
  Points points_vo() const;  ///< active points of the newest window
  int keyframes() const;     ///< so far

 private:
  void take_pose(dso::FrameShell* frame);
  void add_points(const dso::FrameHessian& frame, dso::CalibHessian* calibration);

  mutable std::mutex mutex_;
  int id_ = -1;
  dso::FrameShell* shell_ = nullptr;  ///< of the current frame; lives as long as its system
  dso::SE3 tracked_;
  Points points_vo_;
  int keyframes_ = 0;
};

}  // namespace overfly_adapters
