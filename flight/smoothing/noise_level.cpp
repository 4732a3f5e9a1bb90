#include "flight/smoothing/noise_level.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "flight/smoothing/motion_spline.hpp"

namespace overfly::flight::smoothing {
namespace {

/// The standard deviation of a normal distribution over the median of its sizes.
constexpr double kSigmaPerMedian = 1.4826;
constexpr std::size_t kMaxDifferences = 200'000;

template <typename Sample>
bool at_even_times(std::span<const Sample> four) {
  double shortest = four[1].t_s - four[0].t_s;
  double longest = shortest;
  for (std::size_t i = 2; i < 4; ++i) {
    shortest = std::min(shortest, four[i].t_s - four[i - 1].t_s);
    longest = std::max(longest, four[i].t_s - four[i - 1].t_s);
  }
  return longest <= 1.5 * shortest;
}

double sigma_of(std::vector<double> differences) {
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return kSigmaPerMedian * *middle / std::sqrt(20.0);
}

/// Every n-th index, so that long logs cost no more than kMaxDifferences.
std::size_t stride_for(std::size_t samples) { return 1 + samples / kMaxDifferences; }

}  // namespace

PositionNoise position_noise(std::span<const PositionSample> samples) {
  std::vector<double> horizontal;
  std::vector<double> vertical;
  for (std::size_t i = 0; i + 3 < samples.size(); i += stride_for(samples.size())) {
    const auto four = samples.subspan(i, 4);
    if (!at_even_times(four)) continue;
    const Eigen::Vector3d difference =
        four[3].p_world_m - four[0].p_world_m + 3.0 * (four[1].p_world_m - four[2].p_world_m);
    horizontal.push_back(std::abs(difference.x()));
    horizontal.push_back(std::abs(difference.y()));
    vertical.push_back(std::abs(difference.z()));
  }
  return {sigma_of(std::move(horizontal)), sigma_of(std::move(vertical))};
}

double attitude_noise_rad(std::span<const AttitudeSample> samples) {
  std::vector<double> differences;
  for (std::size_t i = 0; i + 3 < samples.size(); i += stride_for(samples.size())) {
    const auto four = samples.subspan(i, 4);
    if (!at_even_times(four)) continue;
    const auto turn = [&](std::size_t k) {
      return vector_from_rotation(four[1].R_ned_body.conjugate() * four[k].R_ned_body);
    };
    const Eigen::Vector3d difference = turn(3) - turn(0) - 3.0 * turn(2);
    for (const double part : difference) differences.push_back(std::abs(part));
  }
  return sigma_of(std::move(differences));
}

}  // namespace overfly::flight::smoothing
