#include "calibration/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "calibration/solver/first_guess.hpp"
#include "calibration/solver/solve.hpp"

namespace overfly::calibration {
namespace {

constexpr double kOutlierFactor = 3.0;
/// Below this, a view is no outlier however good the others are.
constexpr double kHarmlessPx = 0.1;
constexpr double kLeastNoisePx = 0.1;
constexpr double kMostFocalDeviation = 0.02;

Error invalid(const std::string& what) { return {ErrorCode::kInvalidArgument, what}; }

Status check_input(const Board& board,
                   const PinholeCamera& size,
                   const std::vector<BoardView>& views) {
  if (Status status = board.validate(); !status) return status;
  PinholeCamera sized = size;
  sized.fx_px = sized.fy_px = 1.0;
  sized.cx_px = sized.cy_px = 0.0;
  if (Status status = sized.validate(); !status) return status.error().in("image");
  if (views.size() < kLeastViews || views.size() > kMostViews) {
    return invalid(std::to_string(views.size()) + " views of the board: must be " +
                   std::to_string(kLeastViews) + " to " + std::to_string(kMostViews) +
                   " different ones");
  }
  return {};
}

/// The largest relative deviation of the two focal lengths, for a noise of at least kLeastNoisePx.
double focal_deviation(const Solution& solution) {
  const double noise_px = std::max(solution.sigma_px, kLeastNoisePx);
  const PinholeCamera& c = solution.camera.pinhole();
  return noise_px * std::max(std::sqrt(solution.unit_covariance(0, 0)) / c.fx_px,
                             std::sqrt(solution.unit_covariance(1, 1)) / c.fy_px);
}

double tilt_of(const Pose& T_camera_board) {
  const double cosine = std::abs(T_camera_board.rotation.toRotationMatrix()(2, 2));
  return std::acos(std::clamp(cosine, 0.0, 1.0));
}

Status check_determined(const Solution& solution) {
  const double deviation = focal_deviation(solution);
  if (deviation <= kMostFocalDeviation) return {};
  double most = 0.0;
  for (const Pose& pose : solution.T_camera_board) most = std::max(most, tilt_of(pose));
  char text[240];
  std::snprintf(
      text,
      sizeof text,
      "the views do not determine the focal length: its standard deviation is %.1f %%, must "
      "be at most 2 %%. The largest tilt of the board is %.0f deg: show it tilted by 20 to "
      "45 deg in different directions",
      100.0 * std::min(deviation, 9.99),
      deg_from_rad(most));
  return invalid(text);
}

CameraDeviation deviation_of(const Solution& solution, const LensChoice& lens) {
  const auto of = [&](int i) {
    return solution.sigma_px * std::sqrt(solution.unit_covariance(i, i));
  };
  CameraDeviation deviation{of(0), of(1), of(2), of(3), {}};
  for (int i = 0; i < lens.coefficients(); ++i) {
    deviation.k[static_cast<std::size_t>(i)] = of(4 + i);
  }
  return deviation;
}

template <typename T>
std::vector<T> without(const std::vector<T>& values, const std::vector<bool>& left_out) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!left_out[i]) kept.push_back(values[i]);
  }
  return kept;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Views whose RMS is far above the median of all.
std::vector<bool> outliers(const std::vector<ViewFitQuality>& quality) {
  std::vector<double> rms;
  for (const ViewFitQuality& view : quality) rms.push_back(view.rms_px);
  const double limit = std::max(kHarmlessPx, kOutlierFactor * median(rms));
  std::vector<bool> out;
  for (const double value : rms) out.push_back(value > limit);
  return out;
}

}  // namespace

Result<Calibration> calibrate(const Board& board,
                              const PinholeCamera& size,
                              const LensChoice& lens,
                              const std::vector<BoardView>& views) {
  if (Status status = check_input(board, size, views); !status) return status.error();
  const auto guess = first_guess(board, size, lens, views);
  if (!guess) return invalid("no focal length puts the board in front of the camera in all views");
  const Result<Solution> first = solve(board, lens, views, *guess);
  if (!first) return first.error();
  const std::vector<bool> out = outliers(first->quality);
  const std::vector<BoardView> kept = without(views, out);
  if (kept.size() < kLeastViews) {
    return invalid("only " + std::to_string(kept.size()) +
                   " views agree with each other: must be at least " + std::to_string(kLeastViews));
  }
  const bool all = kept.size() == views.size();
  const Result<Solution> second =
      all ? first : solve(board, lens, kept, {first->camera, without(first->T_camera_board, out)});
  if (!second) return second.error();
  if (Status status = check_determined(*second); !status) return status.error();

  Calibration calibration;
  calibration.camera = second->camera;
  calibration.deviation = deviation_of(*second, lens);
  calibration.rms_px = second->rms_px;
  std::vector<ViewMeasures> measures;
  std::size_t next = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Solution& from = out[i] ? *first : *second;
    const std::size_t at = out[i] ? i : next++;
    const Pose& pose = from.T_camera_board[at];
    const ViewFitQuality& quality = from.quality[at];
    calibration.views.push_back({pose, tilt_of(pose), quality.rms_px, quality.max_px, out[i]});
    if (out[i]) continue;
    calibration.max_px = std::max(calibration.max_px, quality.max_px);
    measures.push_back(measures_of(views[i], board, size.width_px, size.height_px));
  }
  calibration.coverage = coverage_bars(measures);
  return calibration;
}

}  // namespace overfly::calibration
