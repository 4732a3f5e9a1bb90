#include "server/camera/calibrated_camera.hpp"

#include "calibration/model_difference.hpp"
#include "server/calibration/calibrate_images.hpp"

namespace overfly::server {
namespace {

/// The size is arbitrary: the views are scaled with the board.
constexpr calibration::Board kVirtualBoard{9, 6, 0.03};

/// k3 only where the lens has it: it makes the other coefficients of a weaker lens uncertain.
calibration::LensChoice lens_to_estimate(const CameraSpec& camera) {
  const Distortion& lens = camera.model.distortion();
  const bool k3 = lens.model == DistortionModel::kRadtan && lens.k[4] != 0.0;
  return {camera.calibrated->model, k3 && camera.calibrated->model == DistortionModel::kRadtan};
}

CalibratedIntrinsics intrinsics_from(const CalibrationRecord& record, const CameraModel& truth) {
  const calibration::Calibration& result = record.result;
  const calibration::CameraDeviation& noise = result.deviation;
  const calibration::ModelDifference apart = calibration::model_difference(truth, result.camera);
  CalibratedIntrinsics intrinsics;
  intrinsics.model = result.camera;
  intrinsics.deviation = {noise.fx_px, noise.fy_px, noise.cx_px, noise.cy_px, noise.k};
  intrinsics.rms_px = result.rms_px;
  intrinsics.views = static_cast<int>(record.names.size());
  intrinsics.mean_difference_px = apart.mean_px;
  intrinsics.max_difference_px = apart.max_px;
  return intrinsics;
}

}  // namespace

Result<CalibratedIntrinsics> calibrate_camera(const CameraSpec& camera,
                                              std::uint64_t seed,
                                              const CalibrationWatch& watch) {
  const std::string what = "calibrating camera \"" + camera.name + "\"";
  VirtualCalibration request;
  request.camera = {camera.model, camera.sensor, camera.calibrated->views, seed};
  calibration::CalibratorOptions options;
  options.board = kVirtualBoard;
  options.lens = lens_to_estimate(camera);
  CalibrationProgress progress;
  progress.cancel = watch.cancel;
  progress.show = [&](std::size_t done, std::size_t total, const std::string&) {
    if (!watch.notice) return;
    watch.notice(what + ": image " + std::to_string(done) + " of " + std::to_string(total));
  };
  const Result<CalibrationRecord> record = calibrate_virtual(request, options, progress);
  if (!record) return record.error().in(what);
  if (Status valid = record->result.camera.validate(); !valid) {
    return Error{ErrorCode::kInvalidArgument,
                 what + ": the estimate is no camera (" + valid.error().message +
                     "): calibrated.model must suit the lens, and calibrated.views must be enough"};
  }
  return intrinsics_from(*record, camera.model);
}

}  // namespace overfly::server
