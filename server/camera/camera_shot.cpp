#include "server/camera/camera_shot.hpp"

namespace overfly::server {

Status check_recorded_pose(const FrameRow& recorded,
                           std::int64_t t_ns,
                           const Pose& T_world_camera) {
  // Poses are bit-identical on the same machine; another C library may round sines differently.
  constexpr double kCloseM = 1e-6;
  constexpr double kCloseRad = 1e-8;
  const Pose& then = recorded.T_world_camera;
  const double away_m = (then.translation - T_world_camera.translation).norm();
  const double away_rad = rotation_angle_rad(then.rotation, T_world_camera.rotation);
  if (away_m <= kCloseM && away_rad <= kCloseRad && recorded.t_ns == t_ns) return {};
  return Error{ErrorCode::kConflict,
               "frame " + std::to_string(recorded.frame) + ": rendered " + std::to_string(away_m) +
                   " m and " + std::to_string(deg_from_rad(away_rad)) +
                   " deg away from the recorded pose, at " + std::to_string(t_ns) +
                   " ns instead of " + std::to_string(recorded.t_ns) +
                   " ns; the flight's files or this version differ from the run's"};
}

Image grey_of(const Image& image) {
  if (image.channels == 1) return image;
  Image grey(image.width_px, image.height_px, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    const std::uint8_t* rgb = &image.data[3 * i];
    grey.data[i] =
        static_cast<std::uint8_t>((299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2] + 500) / 1000);
  }
  return grey;
}

}  // namespace overfly::server
