#include "flight/height_profile.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace overfly::flight {
namespace {

constexpr int kMargin = 3;      // a basis of degree five extends three knots to each side
constexpr long kHalfSteps = 8;  // ground samples in half a knot distance

/// Centred cardinal B-spline of a degree at x (Schoenberg 1946, by truncated powers).
double basis(int degree, double x) {
  const double half_width = 0.5 * (degree + 1);
  x = -std::abs(x);  // even function; the left half has fewer terms
  if (x <= -half_width) return 0.0;
  double sum = 0.0;
  double binomial = 1.0;
  for (int k = 0; k <= degree + 1; ++k) {
    const double u = x + half_width - k;
    if (u <= 0.0) break;
    double power = 1.0;
    for (int i = 0; i < degree; ++i) power *= u;
    sum += binomial * power;
    binomial *= -static_cast<double>(degree + 1 - k) / (k + 1);
  }
  double factorial = 1.0;
  for (int k = 2; k <= degree; ++k) factorial *= k;
  return sum / factorial;
}

/// The ground height, sampled once at a fixed step from `begin`.
class SampledGround {
 public:
  SampledGround(const std::function<double(double)>& ground,
                double begin_s,
                double end_s,
                double step_s)
      : begin_s_(begin_s), step_s_(step_s) {
    const auto count = static_cast<std::size_t>(std::ceil((end_s - begin_s) / step_s)) + 1;
    heights_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      heights_.push_back(ground(begin_s + static_cast<double>(i) * step_s));
    }
  }
  [[nodiscard]] std::optional<double> first_time_not_finite_s() const {
    const auto bad =
        std::find_if(heights_.begin(), heights_.end(), [](double h) { return !std::isfinite(h); });
    if (bad == heights_.end()) return std::nullopt;
    return begin_s_ + static_cast<double>(bad - heights_.begin()) * step_s_;
  }
  /// Mean around a sample with a triangular window that falls to 0 at `reach` steps to each side.
  /// This is the shortest window that prevents bumps shorter than two knots from appearing as long
  /// waves.
  [[nodiscard]] double mean_around(double t_s, long reach) const {
    const auto last = static_cast<long>(heights_.size()) - 1;
    const long centre = std::lround((t_s - begin_s_) / step_s_);
    double sum = 0.0;
    for (long i = 1 - reach; i < reach; ++i) {
      const auto weight = static_cast<double>(reach - std::abs(i));
      sum += weight * heights_[static_cast<std::size_t>(std::clamp(centre + i, 0L, last))];
    }
    return sum / static_cast<double>(reach * reach);
  }

 private:
  double begin_s_;
  double step_s_;
  std::vector<double> heights_;
};

}  // namespace

Result<HeightProfile> HeightProfile::above(const std::function<double(double)>& ground_up_m,
                                           double height_agl_m,
                                           double duration_s,
                                           const HeightLimits& limits) {
  const double pad_s = (kMargin + 1) * limits.knot_s;
  const double step_s = limits.knot_s / (2 * kHalfSteps);
  const SampledGround ground(ground_up_m, -pad_s, duration_s + pad_s, step_s);
  if (const auto bad_s = ground.first_time_not_finite_s()) {
    return Error{
        ErrorCode::kInvalidArgument,
        "the ground's height under the course is not finite at " + std::to_string(*bad_s) + " s"};
  }
  HeightProfile profile;
  // Keep knots on samples: half the spacing is always a whole number of steps.
  for (long half_steps = kHalfSteps;; half_steps += (half_steps + 3) / 4) {
    profile.knot_s_ = static_cast<double>(2 * half_steps) * step_s;
    const int count = static_cast<int>(std::ceil(duration_s / profile.knot_s_)) + 2 * kMargin + 1;
    profile.control_m_.clear();
    for (int j = 0; j < count; ++j) {
      const double t_s = (j - kMargin) * profile.knot_s_;
      profile.control_m_.push_back(ground.mean_around(t_s, 2 * half_steps) + height_agl_m);
    }
    if (profile.steepest_m_s(duration_s) <= limits.climb_max_m_s) return profile;
    if (profile.knot_s_ > duration_s) break;
  }
  return Error{ErrorCode::kInvalidArgument,
               "the ground under the course is too steep to follow: the climb would exceed " +
                   std::to_string(limits.climb_max_m_s) + " m/s"};
}

double HeightProfile::steepest_m_s(double duration_s) const {
  double steepest = 0.0;
  const double step_s = knot_s_ / 8.0;
  for (double t_s = 0.0; t_s <= duration_s; t_s += step_s) {
    steepest = std::max(steepest, std::abs(at(t_s).climb_m_s));
  }
  return steepest;
}

HeightSample HeightProfile::at(double t_s) const {
  const double x = t_s / knot_s_ + kMargin;
  const int nearest = static_cast<int>(std::lround(x));
  const int last = static_cast<int>(control_m_.size()) - 1;
  HeightSample sample;
  // Sum heights relative to one control value, so that high ground costs no precision.
  const double base_m = control_m_[static_cast<std::size_t>(std::clamp(nearest, 0, last))];
  for (int j = nearest - kMargin; j <= nearest + kMargin; ++j) {
    const double c_m = control_m_[static_cast<std::size_t>(std::clamp(j, 0, last))] - base_m;
    const double u = x - j;
    sample.up_m += c_m * basis(5, u);
    // The derivative of a centred B-spline is the difference of two of one degree less.
    sample.climb_m_s += c_m * (basis(4, u + 0.5) - basis(4, u - 0.5));
    sample.climb_rate_m_s2 += c_m * (basis(3, u + 1.0) - 2.0 * basis(3, u) + basis(3, u - 1.0));
  }
  sample.up_m += base_m;
  sample.climb_m_s /= knot_s_;
  sample.climb_rate_m_s2 /= knot_s_ * knot_s_;
  return sample;
}

}  // namespace overfly::flight
