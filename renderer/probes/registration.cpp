#include "renderer/probes/registration.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "core/algebra/decompositions.hpp"
#include "renderer/camera/cubic_weights.hpp"

namespace overfly::renderer {
namespace {

/// Empty if the sixteen samples do not all lie in the image.
std::optional<double> cubic_sample(const Image& image, double x, double y) {
  const double x0 = std::floor(x);
  const double y0 = std::floor(y);
  if (!(x0 >= 1.0 && y0 >= 1.0 && x0 < image.width_px - 2 && y0 < image.height_px - 2)) {
    return std::nullopt;
  }
  const std::array<double, 4> across = cubic_weights<double>(x - x0);
  const std::array<double, 4> down = cubic_weights<double>(y - y0);
  double sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    const std::uint8_t* row = &image.at(static_cast<int>(x0) - 1, static_cast<int>(y0) - 1 + j);
    sum += down[static_cast<std::size_t>(j)] *
           (across[0] * row[0] + across[1] * row[1] + across[2] * row[2] + across[3] * row[3]);
  }
  return sum;
}

double grey_at(const Image& image, double x, double y) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const double a = x - x0;
  const double b = y - y0;
  return (1.0 - b) * ((1.0 - a) * image.at(x0, y0) + a * image.at(x0 + 1, y0)) +
         b * ((1.0 - a) * image.at(x0, y0 + 1) + a * image.at(x0 + 1, y0 + 1));
}

/// The patch of `seen` around a pixel, with precomputed data for its alignment.
struct GreyPatch {
  std::vector<double> values;
  std::vector<Eigen::Vector2d> gradients;
  Eigen::Matrix2d inverse_hessian = Eigen::Matrix2d::Zero();
};

/// Empty without enough texture.
std::optional<GreyPatch> make_patch(const Image& seen,
                                    int cx,
                                    int cy,
                                    const RegistrationOptions& o) {
  GreyPatch patch;
  Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
  for (int y = cy - o.half_patch_px; y <= cy + o.half_patch_px; ++y) {
    for (int x = cx - o.half_patch_px; x <= cx + o.half_patch_px; ++x) {
      const Eigen::Vector2d gradient(0.5 * (seen.at(x + 1, y) - seen.at(x - 1, y)),
                                     0.5 * (seen.at(x, y + 1) - seen.at(x, y - 1)));
      patch.values.push_back(seen.at(x, y));
      patch.gradients.push_back(gradient);
      H += gradient * gradient.transpose();
    }
  }
  const double pixels = static_cast<double>(patch.values.size());
  // Both are at least 0, therefore they are also the eigenvalues.
  if (singular_values(H)(1) < o.min_texture * pixels) return std::nullopt;
  patch.inverse_hessian = H.inverse();
  return patch;
}

/// Shift at which the patch appears in `predicted`: predicted(pixel + shift) = seen(pixel).
std::optional<Eigen::Vector2d> align(
    const Image& predicted, const GreyPatch& patch, int cx, int cy, const RegistrationOptions& o) {
  constexpr int kIterations = 50;
  constexpr double kClosePx = 1e-4;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    std::size_t k = 0;
    for (int y = cy - o.half_patch_px; y <= cy + o.half_patch_px; ++y) {
      for (int x = cx - o.half_patch_px; x <= cx + o.half_patch_px; ++x, ++k) {
        const double difference =
            grey_at(predicted, x + shift.x(), y + shift.y()) - patch.values[k];
        b += difference * patch.gradients[k];
      }
    }
    const Eigen::Vector2d step = patch.inverse_hessian * b;
    shift -= step;
    if (!(shift.norm() < o.max_shift_px)) return std::nullopt;
    if (step.norm() < kClosePx) break;
  }
  return shift;
}

/// True if all pixels that a patch may touch are valid and in the image.
bool usable(const Image& valid, int cx, int cy, int reach_px) {
  for (int y = cy - reach_px; y <= cy + reach_px; ++y) {
    for (int x = cx - reach_px; x <= cx + reach_px; ++x) {
      if (valid.at(x, y) == 0) return false;
    }
  }
  return true;
}

/// @pre share in [0, 1]
double lower_quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

void compare_greys(const Image& predicted,
                   const Image& seen,
                   const Image& valid,
                   Registration& result) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < seen.data.size(); ++i) {
    if (valid.data[i] != 0) differences.push_back(std::abs(predicted.data[i] - seen.data[i]));
  }
  result.median_grey = lower_quantile(differences, 0.5);
  result.p95_grey = lower_quantile(differences, 0.95);
}

}  // namespace

WarpedImage warp_along(const Image& source, const VectorImage& motion) {
  WarpedImage warped{Image(motion.width_px, motion.height_px, 1),
                     Image(motion.width_px, motion.height_px, 1)};
  for (int y = 0; y < motion.height_px; ++y) {
    for (int x = 0; x < motion.width_px; ++x) {
      const double from_x = x + static_cast<double>(motion.at(x, y, 0));
      const double from_y = y + static_cast<double>(motion.at(x, y, 1));
      const auto value = cubic_sample(source, from_x, from_y);
      if (!value) continue;
      warped.image.at(x, y) = static_cast<std::uint8_t>(std::clamp(*value + 0.5, 0.0, 255.0));
      warped.valid.at(x, y) = 255;
    }
  }
  return warped;
}

Registration register_images(const Image& predicted,
                             const Image& seen,
                             const Image& valid,
                             const RegistrationOptions& options) {
  Registration result;
  const int reach_px = options.half_patch_px + static_cast<int>(options.max_shift_px) + 2;
  std::vector<double> shifts_px;
  for (int cy = reach_px; cy < seen.height_px - reach_px; cy += options.spacing_px) {
    for (int cx = reach_px; cx < seen.width_px - reach_px; cx += options.spacing_px) {
      if (!usable(valid, cx, cy, reach_px)) continue;
      const auto patch = make_patch(seen, cx, cy, options);
      if (!patch) continue;
      ++result.patches;
      const auto shift = align(predicted, *patch, cx, cy, options);
      shifts_px.push_back(shift ? shift->norm() : options.max_shift_px);
      if (shift) {
        result.mean_px += *shift;
      } else {
        ++result.lost;
      }
    }
  }
  if (result.patches > result.lost) result.mean_px /= result.patches - result.lost;
  result.median_px = lower_quantile(shifts_px, 0.5);
  result.p95_px = lower_quantile(shifts_px, 0.95);
  compare_greys(predicted, seen, valid, result);
  return result;
}

}  // namespace overfly::renderer
