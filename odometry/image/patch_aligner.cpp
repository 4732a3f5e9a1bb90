#include "odometry/image/patch_aligner.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace overfly::odometry {
namespace {

constexpr float kHalf = 0.5F * (kPatchSize - 1);
constexpr int kMaxIterations = 12;
constexpr float kSettledPx = 0.008F;
/// Smallest eigenvalue of the gradients' mean square [grey levels^2 per px^2]. Below it the patch
/// slides along an edge or is dominated by noise.
constexpr float kMinEigenvalue = 4.0F;
constexpr float kMaxTravelPx = 10.0F;

/// Samples a (P + 2)^2 patch around a centre with the warp applied.
bool sample_warped(const cv::Mat& image,
                   const Eigen::Vector2f& centre,
                   const Eigen::Matrix2f& A,
                   const Eigen::Vector2f& g,
                   BorderPatch& patch) {
  const float reach = kHalf + 1.0F;
  // The plane is in front of both views over the whole patch if it is at the patch's corners. So
  // are the unused samples of a line: they lie at most 2 px beyond, where the depth is at least
  // 0.3.
  if (g.cwiseAbs().sum() * reach > 0.5F) return false;
  for (const float u : {-reach, reach}) {
    for (const float v : {-reach, reach}) {
      const Eigen::Vector2f d(u, v);
      const Eigen::Vector2f p = centre + A * d / (1.0F + g.dot(d));
      if (p.x() < 0.0F || p.y() < 0.0F || p.x() >= static_cast<float>(image.cols - 1) ||
          p.y() >= static_cast<float>(image.rows - 1)) {
        return false;
      }
    }
  }
  best_patch_sampler().warped(image, {centre, A, g}, patch);
  return true;
}

/// Fills the template from a sampled patch; returns false without texture in both directions.
bool fill_template(const BorderPatch& patch, PatchTemplate& out) {
  for (int row = 0; row < kPatchSize; ++row) {
    const float* p = patch.data() + static_cast<std::ptrdiff_t>(row + 1) * kBorderSide + 1;
    const auto first = static_cast<std::ptrdiff_t>(row) * kPatchSize;
    using Line = Eigen::Matrix<float, kPatchSize, 1>;
    const auto at = [p](std::ptrdiff_t offset) { return Eigen::Map<const Line>(p + offset); };
    out.value.segment<kPatchSize>(first) = at(0);
    out.gradient_x.segment<kPatchSize>(first) = 0.5F * (at(1) - at(-1));
    out.gradient_y.segment<kPatchSize>(first) = 0.5F * (at(kBorderSide) - at(-kBorderSide));
  }
  float sum = 0.0F, sum_x = 0.0F, sum_y = 0.0F, sum_xx = 0.0F, sum_xy = 0.0F, sum_yy = 0.0F;
  for (int i = 0; i < kPatchArea; ++i) {
    const float gx = out.gradient_x[i];
    const float gy = out.gradient_y[i];
    sum += out.value[i];
    sum_x += gx;
    sum_y += gy;
    sum_xx += gx * gx;
    sum_xy += gx * gy;
    sum_yy += gy * gy;
  }
  const Eigen::Vector2f gradient_sum(sum_x, sum_y);
  Eigen::Matrix2f H;
  H << sum_xx, sum_xy, sum_xy, sum_yy;
  // The mean is a free parameter: eliminate it from the normal equations.
  H -= gradient_sum * gradient_sum.transpose() / static_cast<float>(kPatchArea);
  out.value.array() -= sum / static_cast<float>(kPatchArea);
  out.gradient_x.array() -= gradient_sum.x() / static_cast<float>(kPatchArea);
  out.gradient_y.array() -= gradient_sum.y() / static_cast<float>(kPatchArea);
  out.energy = out.value.squaredNorm();
  out.gradient_value = {out.value.dot(out.gradient_x), out.value.dot(out.gradient_y)};
  const float half_trace = 0.5F * H.trace();
  const float root = std::sqrt(std::max(0.0F, half_trace * half_trace - H.determinant()));
  out.least_eigenvalue = half_trace - root;
  if (out.least_eigenvalue < kMinEigenvalue * kPatchArea) return false;
  out.inverse_hessian = H.inverse();
  return true;
}

bool fill_template(const Pyramid& source,
                   const Eigen::Vector2d& source_pixel,
                   const PatchWarp& warp,
                   int level,
                   PatchTemplate& out) {
  const double area = 1.0 / warp.A_source_other.determinant();
  if (!(area > 0.1 && area < 10.0)) return false;
  // Source level with the pixel size nearest to that of the searched level.
  const int change = static_cast<int>(std::lround(-0.5 * std::log2(area)));
  const int source_level = std::clamp(level + change, 0, source.level_count() - 1);
  const double scale = std::ldexp(1.0, level - source_level);
  const Eigen::Matrix2f A = (scale * warp.A_source_other).cast<float>();
  const Eigen::Vector2f g = (std::ldexp(1.0, level) * warp.g_per_px).cast<float>();
  const Eigen::Vector2f centre = (source_pixel * std::ldexp(1.0, -source_level)).cast<float>();
  BorderPatch sampled;
  if (!sample_warped(source.level(source_level), centre, A, g, sampled)) return false;
  out.level = level;
  return fill_template(sampled, out);
}

struct Comparison {
  Eigen::Vector2f gradient_error = Eigen::Vector2f::Zero();
  float correlation = 0.0F;
};

Comparison compare(const PatchTemplate& patch, const PatchVector& sampled) {
  const float sum = sampled.sum();
  const float cross = sampled.dot(patch.value);
  const float energy = std::max(patch.energy, 1e-3F);
  Comparison result;
  const float variance = std::max(sampled.squaredNorm() - sum * sum / kPatchArea, 1e-3F);
  result.correlation = cross / std::sqrt(variance * energy);
  // Contrast of the image relative to the patch; bounded so that a bad start cannot diverge.
  const float gain = std::clamp(cross / energy, 0.4F, 2.5F);
  result.gradient_error =
      Eigen::Vector2f(sampled.dot(patch.gradient_x), sampled.dot(patch.gradient_y)) / gain -
      patch.gradient_value;
  return result;
}

}  // namespace

PatchWarp warp_around(const Eigen::Matrix3d& H_source_other, const Eigen::Vector2d& other_pixel) {
  const Eigen::Vector3d q = H_source_other * other_pixel.homogeneous();
  PatchWarp warp;
  warp.g_per_px = H_source_other.block<1, 2>(2, 0).transpose() / q.z();
  warp.A_source_other =
      H_source_other.topLeftCorner<2, 2>() / q.z() - q.hnormalized() * warp.g_per_px.transpose();
  return warp;
}

void fetch_patch(const Pyramid& image, const Eigen::Vector2d& pixel, int level) {
  if (level >= image.level_count()) return;
  const cv::Mat& pixels = image.level(level);
  const Eigen::Vector2d middle = pixel * std::ldexp(1.0, -level);
  // Negated, so that NaN also counts as outside.
  if (!(middle.minCoeff() >= 0.0 && middle.x() < pixels.cols && middle.y() < pixels.rows)) return;
  constexpr int kReach = 3 * kBorderSide / 4;  // a patch may be turned
  const int left = std::max(static_cast<int>(middle.x()) - kReach, 0);
  const int right = std::min(static_cast<int>(middle.x()) + kReach, pixels.cols - 1);
  const int bottom = std::min(static_cast<int>(middle.y()) + kReach, pixels.rows - 1);
  for (int y = std::max(static_cast<int>(middle.y()) - kReach, 0); y <= bottom; ++y) {
    const std::uint8_t* row = pixels.ptr<std::uint8_t>(y);
    __builtin_prefetch(row + left);
    __builtin_prefetch(row + right);
    asm volatile("");  // GCC removes calls of functions that only ask for cache lines.
  }
}

std::optional<PatchTemplate> make_template(const Pyramid& source,
                                           const Eigen::Vector2d& source_pixel,
                                           const PatchWarp& warp,
                                           int level) {
  // Not empty at first: GCC sets all of an empty optional to zero.
  std::optional<PatchTemplate> result(std::in_place);
  if (!fill_template(source, source_pixel, warp, level, *result)) result.reset();
  return result;
}

int patch_level_of(int scale_level, double scale_factor) {
  const double octaves = scale_level * std::log2(scale_factor);
  return std::clamp(static_cast<int>(std::lround(octaves)), 0, 2);
}

std::optional<int> textured_level(const Pyramid& image,
                                  const Eigen::Vector2d& pixel,
                                  int finest,
                                  int coarsest) {
  const int last = std::min(coarsest, image.level_count() - 1);
  std::optional<int> best;
  float best_information = 0.0F;
  for (int level = finest; level <= last; ++level) {
    const auto patch = make_template(image, pixel, PatchWarp{}, level);
    if (!patch) continue;
    // At level l a pixel is 2^l as wide and white noise is 2^-l as strong. Noise of quantisation
    // and interpolation, half as strong at the finest level, does not decrease.
    const float variance = 1.0F + std::ldexp(0.25F, 2 * level);
    const float information = patch->least_eigenvalue / variance;
    if (information <= best_information) continue;
    best = level;
    best_information = information;
  }
  return best;
}

std::optional<PatchMatch> align_patch(const Pyramid& image,
                                      const PatchTemplate& patch,
                                      const Eigen::Vector2d& start_pixel) {
  if (patch.level >= image.level_count()) return std::nullopt;
  const cv::Mat& level = image.level(patch.level);
  const double scale = std::ldexp(1.0, patch.level);
  const Eigen::Vector2f start =
      (start_pixel / scale).cast<float>() - Eigen::Vector2f::Constant(kHalf);
  Eigen::Vector2f corner = start;
  const Eigen::Vector2f limit(level.cols - kPatchSize - 1, level.rows - kPatchSize - 1);
  PatchVector sampled;
  bool settled = false;
  Comparison comparison;
  for (int iteration = 0; iteration < kMaxIterations && !settled; ++iteration) {
    // Negated, so that NaN also counts as outside.
    if (!(corner.minCoeff() >= 0.0F && corner.x() < limit.x() && corner.y() < limit.y())) {
      return std::nullopt;
    }
    best_patch_sampler().shifted(level, corner.x(), corner.y(), sampled.data());
    comparison = compare(patch, sampled);
    const Eigen::Vector2f step = patch.inverse_hessian * comparison.gradient_error;
    corner -= step;
    settled = step.squaredNorm() < kSettledPx * kSettledPx;
  }
  if (!settled || !((corner - start).squaredNorm() < kMaxTravelPx * kMaxTravelPx)) {
    return std::nullopt;
  }
  PatchMatch match;
  match.pixel = (corner + Eigen::Vector2f::Constant(kHalf)).cast<double>() * scale;
  match.correlation = comparison.correlation;
  return match;
}

}  // namespace overfly::odometry
