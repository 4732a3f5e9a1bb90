#include "server/calibration/virtual_camera.hpp"

#include <string>
#include <utility>

#include "calibration/calibration.hpp"
#include "calibration/virtual/virtual_board.hpp"
#include "calibration/virtual/virtual_views.hpp"

namespace overfly::server {
namespace {

Error bad_virtual_camera(const std::string& what) { return {ErrorCode::kInvalidArgument, what}; }

Status check_virtual_camera(const VirtualCameraOptions& options) {
  if (Status status = options.camera.validate(); !status) return status.error().in("camera");
  const auto least = static_cast<int>(calibration::kLeastViews);
  const auto most = static_cast<int>(calibration::kMostViews);
  if (options.views >= least && options.views <= most) return {};
  return bad_virtual_camera("views = " + std::to_string(options.views) + ": must be in [" +
                            std::to_string(least) + ", " + std::to_string(most) + "]");
}

}  // namespace

Result<VirtualCamera> VirtualCamera::create(const VirtualCameraOptions& options,
                                            const calibration::Board& board) {
  if (Status status = check_virtual_camera(options); !status) return status.error();
  VirtualCamera camera(options, board);
  auto sensor = sensor::Sensor::create(options.sensor, options.camera, options.seed);
  if (!sensor) return sensor.error().in("sensor");
  camera.sensor_ = std::move(*sensor);
  camera.poses_ = calibration::virtual_views(options.camera, board, options.views, options.seed);
  if (camera.poses_.empty()) {
    return bad_virtual_camera("the board fits nowhere into the camera's image");
  }
  if (const auto& automatic = options.sensor.auto_exposure) {
    camera.settle(automatic->settle_frames);
  }
  return camera;
}

/// Lets auto-exposure settle before the first image that counts.
void VirtualCamera::settle(int frames) {
  const RadianceImage light = painter_.draw(board_, poses_.front());
  for (int i = frames; i > 0; --i) (void)sensor_->expose(light, -i);
}

Image VirtualCamera::image(std::size_t view) {
  const RadianceImage light = painter_.draw(board_, poses_.at(view));
  return sensor_->expose(light, static_cast<std::int64_t>(view)).image;
}

}  // namespace overfly::server
