// NEES: Bar-Shalom, Li, Kirubarajan 2001, Estimation with Applications to Tracking and Navigation,
// sec. 5.4.2 (doi:10.1002/0471221279).
#include "evaluation/consistency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "evaluation/statistics/chi_square.hpp"

namespace overfly::evaluation {
namespace {

constexpr std::array<std::pair<Honesty, const char*>, 3> kHonestyNames{
    {{Honesty::kConsistent, "consistent"},
     {Honesty::kOverconfident, "overconfident"},
     {Honesty::kTooCautious, "too cautious"}}};

}  // namespace

const char* to_string(Honesty honesty) {
  for (const auto& [value, name] : kHonestyNames) {
    if (value == honesty) return name;
  }
  return "";
}

std::optional<Honesty> honesty_from(const std::string& text) {
  for (const auto& [value, name] : kHonestyNames) {
    if (text == name) return value;
  }
  return std::nullopt;
}

double Nees::deviation_ratio() const { return std::sqrt(mean / degrees); }

Band nees_band_95(int degrees, std::size_t samples) {
  const auto count = static_cast<double>(samples);
  const double all = count * degrees;
  return {chi_square_quantile(0.025, all) / count, chi_square_quantile(0.975, all) / count};
}

Nees nees_of(const std::vector<double>& squared, int degrees) {
  Nees nees;
  nees.degrees = degrees;
  nees.samples = static_cast<int>(squared.size());
  nees.mean = std::accumulate(squared.begin(), squared.end(), 0.0) / nees.samples;
  nees.band_95 = nees_band_95(degrees, squared.size());
  nees.pose_band_95 = nees_band_95(degrees, 1);
  const auto inside = std::count_if(squared.begin(), squared.end(), [&](double value) {
    return value >= nees.pose_band_95.low && value <= nees.pose_band_95.high;
  });
  nees.share_in_band = static_cast<double>(inside) / nees.samples;
  if (nees.mean > nees.band_95.high) nees.honesty = Honesty::kOverconfident;
  if (nees.mean < nees.band_95.low) nees.honesty = Honesty::kTooCautious;
  return nees;
}

std::optional<Honesty> Consistency::honesty() const {
  std::optional<Honesty> worst;
  for (const std::optional<Nees>& part : {position, rotation, pose}) {
    if (!part) continue;
    if (part->honesty == Honesty::kOverconfident) return Honesty::kOverconfident;
    if (!worst || part->honesty == Honesty::kTooCautious) worst = part->honesty;
  }
  return worst;
}

}  // namespace overfly::evaluation
