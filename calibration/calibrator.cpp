#include "calibration/calibrator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
    case ViewVerdict::kMoving:
      return "board moves";
    case ViewVerdict::kNothingNew:
      return "nothing new";
    case ViewVerdict::kNotAsked:
      return "not asked for";
    case ViewVerdict::kEnough:
      break;
  }
  return "enough views";
}

Result<Calibrator> Calibrator::create(const CalibratorOptions& options) {
  if (Status status = options.board.validate(); !status) return status.error();
  if (options.most_views < kLeastViews || options.most_views > kMostViews) {
    return Error{ErrorCode::kInvalidArgument,
                 "most_views = " + std::to_string(options.most_views) + ": must be in [" +
                     std::to_string(kLeastViews) + ", " + std::to_string(kMostViews) + "]"};
  }
  if (!options.accept_symmetric) {
    if (Status status = require_unambiguous(options.board); !status) return status.error();
  }
  return Calibrator(options);
}

ViewVerdict Calibrator::verdict_on(const BoardView& view,
                                   const ViewMeasures& measures,
                                   double diagonal_px,
                                   Capture capture) const {
  if (capture == Capture::kNone) return ViewVerdict::kNotAsked;
  const auto shift_px = [&](const BoardView& other) { return mean_shift_px(other, view); };
  const bool duplicate = std::any_of(views_.begin(), views_.end(), [&](const BoardView& taken) {
    return shift_px(taken) < kDuplicateShift * diagonal_px;
  });
  if (duplicate) return ViewVerdict::kNearDuplicate;
  if (!options_.live || capture == Capture::kNow) return ViewVerdict::kTaken;
  const bool old = std::any_of(measures_.begin(), measures_.end(), [&](const ViewMeasures& taken) {
    return novelty(taken, measures) < kLeastNovelty;
  });
  if (old) return ViewVerdict::kNothingNew;
  const bool still = before_ && shift_px(*before_) <= kMostMotion * diagonal_px;
  return still ? ViewVerdict::kTaken : ViewVerdict::kMoving;
}

Result<ViewVerdict> Calibrator::add(const Image& image, const std::string& name, Capture capture) {
  before_ = std::exchange(seen_, std::nullopt);
  const bool same = image.width_px == size_.width_px && image.height_px == size_.height_px;
  if (!views_.empty() && !same) {
    return Error{ErrorCode::kInvalidArgument,
                 std::to_string(image.width_px) + " x " + std::to_string(image.height_px) +
                     " px: must be " + std::to_string(size_.width_px) + " x " +
                     std::to_string(size_.height_px) + " px, as the first view"};
  }
  if (views_.size() >= options_.most_views) return ViewVerdict::kEnough;
  auto view = detect_board(image, options_.board);
  if (!view) return view.error();
  if (!*view) return ViewVerdict::kNoBoard;
  seen_ = std::move(*view);
  const ViewMeasures measures =
      measures_of(*seen_, options_.board, image.width_px, image.height_px);
  const double diagonal_px = std::hypot(image.width_px, image.height_px);
  const ViewVerdict verdict = verdict_on(*seen_, measures, diagonal_px, capture);
  if (verdict != ViewVerdict::kTaken) return verdict;
  measures_.push_back(measures);
  size_.width_px = image.width_px;
  size_.height_px = image.height_px;
  views_.push_back(*seen_);
  names_.push_back(name);
  return ViewVerdict::kTaken;
}

Result<Calibration> Calibrator::solve() const {
  return calibrate(options_.board, size_, options_.lens, views_);
}

}  // namespace overfly::calibration
