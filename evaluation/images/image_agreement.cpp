#include "evaluation/images/image_agreement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace overfly::evaluation {
namespace {

constexpr int kLeastSidePx = 16;
constexpr int kCornerThreshold = 20;
constexpr double kLeastCommon = 0.25;

/// A view of the pixels; OpenCV does not write to it.
cv::Mat view_of(const Image& image) {
  return {image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data.data())};
}

/// Sums of pairs of grey values.
class PairSums {
 public:
  void add(double a, double b) {
    count_ += 1.0;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] std::optional<double> correlation() const {
    const double var_a = count_ * aa_ - a_ * a_;
    const double var_b = count_ * bb_ - b_ * b_;
    if (!(var_a > 0.0) || !(var_b > 0.0)) return std::nullopt;
    return std::clamp((count_ * ab_ - a_ * b_) / std::sqrt(var_a * var_b), -1.0, 1.0);
  }

 private:
  double count_ = 0.0;
  double a_ = 0.0;
  double b_ = 0.0;
  double aa_ = 0.0;
  double bb_ = 0.0;
  double ab_ = 0.0;
};

std::optional<double> correlation_of(const Image& real, const Image& rendered) {
  PairSums sums;
  for (std::size_t i = 0; i < real.data.size(); ++i) sums.add(real.data[i], rendered.data[i]);
  return sums.correlation();
}

/// The real image is sampled bilinearly at the positions of the other one's pixels.
std::optional<double> aligned_correlation(const Image& real,
                                          const Image& rendered,
                                          const Eigen::Vector2d& offset_px) {
  const int dx = static_cast<int>(std::floor(offset_px.x()));
  const int dy = static_cast<int>(std::floor(offset_px.y()));
  const double a = offset_px.x() - dx;
  const double b = offset_px.y() - dy;
  PairSums sums;
  for (int y = std::max(0, -dy); y < std::min(real.height_px, real.height_px - 1 - dy); ++y) {
    for (int x = std::max(0, -dx); x < std::min(real.width_px, real.width_px - 1 - dx); ++x) {
      const double top = (1.0 - a) * real.at(x + dx, y + dy) + a * real.at(x + dx + 1, y + dy);
      const double bottom =
          (1.0 - a) * real.at(x + dx, y + dy + 1) + a * real.at(x + dx + 1, y + dy + 1);
      sums.add((1.0 - b) * top + b * bottom, rendered.at(x, y));
    }
  }
  if (sums.count() < kLeastCommon * static_cast<double>(real.data.size())) return std::nullopt;
  return sums.correlation();
}

/// Moves the offset to the best fit of real(p + offset) * gain + bias to rendered(p), by Gauss and
/// Newton's method. @return empty if it does not converge near the start
std::optional<Eigen::Vector2d> refined(const Image& real,
                                       const Image& rendered,
                                       const Eigen::Vector2d& start_px) {
  constexpr int kIterations = 20;
  constexpr double kConverged = 1e-4;
  constexpr double kFarPx = 2.0;
  constexpr double kSamples = 1e5;
  const int step = std::max(1, static_cast<int>(std::sqrt(real.data.size() / kSamples)));
  Eigen::Vector2d offset = start_px;
  double gain = 1.0;
  double bias = 0.0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const int dx = static_cast<int>(std::floor(offset.x()));
    const int dy = static_cast<int>(std::floor(offset.y()));
    const double a = offset.x() - dx;
    const double b = offset.y() - dy;
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (int y = std::max(0, -dy); y < std::min(real.height_px, real.height_px - 1 - dy);
         y += step) {
      for (int x = std::max(0, -dx); x < std::min(real.width_px, real.width_px - 1 - dx);
           x += step) {
        const double p00 = real.at(x + dx, y + dy);
        const double p10 = real.at(x + dx + 1, y + dy);
        const double p01 = real.at(x + dx, y + dy + 1);
        const double p11 = real.at(x + dx + 1, y + dy + 1);
        const double value = (1 - b) * ((1 - a) * p00 + a * p10) + b * ((1 - a) * p01 + a * p11);
        const Eigen::Vector4d row(gain * ((1 - b) * (p10 - p00) + b * (p11 - p01)),
                                  gain * ((1 - a) * (p01 - p00) + a * (p11 - p10)),
                                  value,
                                  1.0);
        normal.noalias() += row * row.transpose();
        right += row * (rendered.at(x, y) - gain * value - bias);
      }
    }
    const Eigen::Vector4d change = normal.ldlt().solve(right);
    if (!change.allFinite()) return std::nullopt;
    offset += change.head<2>();
    gain += change.z();
    bias += change.w();
    if (!((offset - start_px).norm() < kFarPx) || !(gain > 0.0)) return std::nullopt;
    if (change.head<2>().norm() < kConverged) return offset;
  }
  return std::nullopt;
}

int corners_of(const Image& image) {
  std::vector<cv::KeyPoint> corners;
  cv::FAST(view_of(image), corners, kCornerThreshold, true);
  return static_cast<int>(corners.size());
}

}  // namespace

Result<ImageAgreement> compare_images(const Image& real, const Image& rendered) {
  if (real.channels != 1 || rendered.channels != 1 || real.width_px != rendered.width_px ||
      real.height_px != rendered.height_px ||
      std::min(real.width_px, real.height_px) < kLeastSidePx) {
    return Error{ErrorCode::kInvalidArgument,
                 "images of " + std::to_string(real.width_px) + " x " +
                     std::to_string(real.height_px) + " and " + std::to_string(rendered.width_px) +
                     " x " + std::to_string(rendered.height_px) +
                     " px: must be grey, of one size, and at least 16 x 16 px"};
  }
  ImageAgreement agreement;
  agreement.correlation = correlation_of(real, rendered);
  agreement.corners_real = corners_of(real);
  agreement.corners_virtual = corners_of(rendered);
  if (!agreement.correlation) return agreement;
  cv::Mat real_values;
  cv::Mat rendered_values;
  cv::Mat window;
  view_of(real).convertTo(real_values, CV_32F);
  view_of(rendered).convertTo(rendered_values, CV_32F);
  cv::createHanningWindow(window, real_values.size(), CV_32F);
  double peak = 0.0;
  const cv::Point2d shift = cv::phaseCorrelate(rendered_values, real_values, window, &peak);
  if (!std::isfinite(shift.x) || !std::isfinite(shift.y) || !std::isfinite(peak)) return agreement;
  const Eigen::Vector2d offset_px(shift.x, shift.y);
  agreement.peak = peak;
  agreement.offset_px = offset_px;
  agreement.correlation_aligned = aligned_correlation(real, rendered, offset_px);
  const std::optional<Eigen::Vector2d> better = refined(real, rendered, offset_px);
  if (!better) return agreement;
  const std::optional<double> correlation = aligned_correlation(real, rendered, *better);
  if (!correlation || *correlation < agreement.correlation_aligned.value_or(-1.0)) return agreement;
  agreement.offset_px = better;
  agreement.correlation_aligned = correlation;
  return agreement;
}

}  // namespace overfly::evaluation
