// A virtual camera in front of a virtual board.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/virtual/virtual_board.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "sensor/sensor.hpp"
#include "sensor/sensor_model.hpp"

namespace overfly::server {

struct VirtualCameraOptions {
  CameraModel camera;          ///< the truth
  sensor::SensorModel sensor;  ///< its defocus and noise; the default leaves the image as drawn
  int views = 20;              ///< in [4, 1000]
  std::uint64_t seed = 1;
};

/// Draws the views of calibration::virtual_views and exposes them. Equal options give equal images.
class VirtualCamera {
 public:
  /// Errors: kInvalidArgument naming a field and its limit, or if the board fits nowhere into the
  /// image; as Sensor::create.
  static Result<VirtualCamera> create(const VirtualCameraOptions& options,
                                      const calibration::Board& board);

  [[nodiscard]] std::size_t views() const { return poses_.size(); }
  [[nodiscard]] const CameraModel& model() const { return painter_.camera(); }
  /// The image of a view; call it in order, because auto-exposure follows from the images before.
  [[nodiscard]] Image image(std::size_t view);

 private:
  VirtualCamera(const VirtualCameraOptions& options, const calibration::Board& board)
      : painter_(CameraModel(options.camera)), board_(board) {}
  void settle(int frames);

  calibration::BoardPainter painter_;
  calibration::Board board_;
  std::vector<Pose> poses_;
  std::unique_ptr<sensor::Sensor> sensor_;
};

}  // namespace overfly::server
