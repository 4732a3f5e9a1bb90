// What DSO publishes of the frame that it works on. C++11.
#pragma once

#include <FullSystem/FullSystem.h>
#include <FullSystem/HessianBlocks.h>
#include <IOWrapper/Output3DWrapper.h>
#include <util/FrameShell.h>

#include <mutex>
#include <vector>

namespace overfly_adapters {

using Points = std::vector<Eigen::Vector3d, Eigen::aligned_allocator<Eigen::Vector3d>>;

/// Takes poses and points. In real time DSO's mapping publishes from a thread of its own.
class DsoPublications : public dso::IOWrap::Output3DWrapper {
 public:
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW

  /// What comes from now on counts where it is of the frame with this identifier.
  void begin_frame(int id);

  void publishCamPose(dso::FrameShell* frame, dso::CalibHessian* calibration) override;
  void publishKeyframes(std::vector<dso::FrameHessian*>& frames,
                        bool final,
                        dso::CalibHessian* calibration) override;

  /// Of the frame that began; false without one. `refined`: as mapping has it by now, which is
  /// sound only while no mapping runs; else as tracked.
  bool pose(bool refined, dso::SE3* T_vo_camera) const;
  Points points_vo() const;  ///< the active ones of the newest window
  int keyframes() const;     ///< so far

 private:
  void take_pose(dso::FrameShell* frame);
  void add_points(const dso::FrameHessian& frame, dso::CalibHessian* calibration);

  mutable std::mutex mutex_;
  int id_ = -1;
  dso::FrameShell* shell_ = nullptr;  ///< of the frame that began; lives as long as its system
  dso::SE3 tracked_;
  Points points_vo_;
  int keyframes_ = 0;
};

}  // namespace overfly_adapters
