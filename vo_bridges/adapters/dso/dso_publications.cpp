#include "vo_bridges/adapters/dso/dso_publications.hpp"

#include <algorithm>

namespace overfly_adapters {

void DsoPublications::begin_frame(int id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  id_ = id;
  shell_ = nullptr;
}

void DsoPublications::publishCamPose(dso::FrameShell* frame, dso::CalibHessian* /*calibration*/) {
  const std::lock_guard<std::mutex> lock(mutex_);
  take_pose(frame);
}

void DsoPublications::publishKeyframes(std::vector<dso::FrameHessian*>& frames,
                                       bool final,
                                       dso::CalibHessian* calibration) {
  if (final) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  points_vo_.clear();
  for (dso::FrameHessian* frame : frames) {
    add_points(*frame, calibration);
    // The frame that completes the initialisation becomes a keyframe without publishCamPose.
    if (shell_ == nullptr) take_pose(frame->shell);
  }
  keyframes_ = std::max(keyframes_, frames.empty() ? 0 : frames.back()->frameID + 1);
}

bool DsoPublications::pose(bool refined, dso::SE3* T_vo_camera) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (shell_ == nullptr || !shell_->poseValid) return false;
  *T_vo_camera = refined ? shell_->camToWorld : tracked_;
  return T_vo_camera->matrix().allFinite();
}

Points DsoPublications::points_vo() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return points_vo_;
}

int DsoPublications::keyframes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return keyframes_;
}

void DsoPublications::take_pose(dso::FrameShell* frame) {
  if (frame->incoming_id != id_) return;
  shell_ = frame;
  tracked_ = frame->camToWorld;
}

void DsoPublications::add_points(const dso::FrameHessian& frame, dso::CalibHessian* calibration) {
  for (const dso::PointHessian* point : frame.pointHessians) {
    if (!(point->idepth_scaled > 0.0F)) continue;
    const double depth = 1.0 / static_cast<double>(point->idepth_scaled);
    const Eigen::Vector3d p_camera(
        depth * static_cast<double>((point->u - calibration->cxl()) / calibration->fxl()),
        depth * static_cast<double>((point->v - calibration->cyl()) / calibration->fyl()),
        depth);
    points_vo_.push_back(frame.shell->camToWorld * p_camera);
  }
}

}  // namespace overfly_adapters
