#include "calibration/calibrator.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/detection/detect_board.hpp"

namespace overfly::calibration {

const char* to_string(ViewVerdict verdict) {
  switch (verdict) {
    case ViewVerdict::kTaken:
      return "taken";
    case ViewVerdict::kNoBoard:
      return "no board";
    case ViewVerdict::kNearDuplicate:
      return "near duplicate";
    case ViewVerdict::kEnough:
      break;
  }
  return "enough views";
}

Result<Calibrator> Calibrator::create(const CalibratorOptions& options) {
  if (Status status = options.board.validate(); !status) return status.error();
  if (!options.accept_symmetric) {
    if (Status status = require_unambiguous(options.board); !status) return status.error();
  }
  return Calibrator(options);
}

Result<ViewVerdict> Calibrator::add(const Image& image, const std::string& name) {
  const bool same = image.width_px == size_.width_px && image.height_px == size_.height_px;
  if (!views_.empty() && !same) {
    return Error{ErrorCode::kInvalidArgument,
                 std::to_string(image.width_px) + " x " + std::to_string(image.height_px) +
                     " px: must be " + std::to_string(size_.width_px) + " x " +
                     std::to_string(size_.height_px) + " px, as the first view"};
  }
  if (views_.size() >= kMostViews) return ViewVerdict::kEnough;
  auto view = detect_board(image, options_.board);
  if (!view) return view.error();
  if (!*view) return ViewVerdict::kNoBoard;
  const double least_px = kDuplicateShift * std::hypot(image.width_px, image.height_px);
  const bool duplicate = std::any_of(views_.begin(), views_.end(), [&](const BoardView& taken) {
    return mean_shift_px(taken, **view) < least_px;
  });
  if (duplicate) return ViewVerdict::kNearDuplicate;
  measures_.push_back(measures_of(**view, options_.board, image.width_px, image.height_px));
  size_.width_px = image.width_px;
  size_.height_px = image.height_px;
  views_.push_back(std::move(**view));
  names_.push_back(name);
  return ViewVerdict::kTaken;
}

Result<Calibration> Calibrator::solve() const {
  return calibrate(options_.board, size_, options_.lens, views_);
}

}  // namespace overfly::calibration
