#include "renderer/raycast/ground/shutter.hpp"

namespace overfly::renderer::raycast {

RowPose RowPose::of(const Pose& T_world_camera) {
  return {T_world_camera.rotation.normalized().toRotationMatrix(), T_world_camera.translation};
}

ShutterPoses::ShutterPoses(const CameraRequest& request, std::int64_t offset_ns) {
  const CameraMotion& motion = request.T_world_camera;
  if (request.readout_ns == 0 || motion.still()) {
    poses_.push_back(RowPose::of(motion.at(request.t_ns + offset_ns)));
    return;
  }
  const int half_rows = 2 * request.camera.pinhole().height_px;
  poses_.reserve(static_cast<std::size_t>(half_rows) + 1);
  for (int i = 0; i <= half_rows; ++i) {
    const std::int64_t t_ns = request.row_time_ns(0.5 * (i - 1)) + offset_ns;
    poses_.push_back(RowPose::of(motion.at(t_ns)));
  }
}

}  // namespace overfly::renderer::raycast
