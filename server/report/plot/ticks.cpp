#include "server/report/plot/ticks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace overfly::server::plot {
namespace {

/// Slack for ticks on the range's ends, in steps.
constexpr double kSlack = 1e-9;
constexpr double kMantissas[] = {1.0, 2.0, 5.0};

double power_of_ten(int exponent) { return std::pow(10.0, exponent); }

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(value) + kSlack)); }

double first_multiple(const Range& range, double step) {
  return std::ceil(range.low / step - kSlack);
}

double last_multiple(const Range& range, double step) {
  return std::floor(range.high / step + kSlack);
}

/// The finest nice step with at most so many ticks.
double step_for(const Range& range, int most, int* exponent) {
  for (int power = exponent_of(range.span() / most) - 1;; ++power) {
    for (const double mantissa : kMantissas) {
      const double step = mantissa * power_of_ten(power);
      *exponent = power;
      if (last_multiple(range, step) - first_multiple(range, step) + 1.0 <= most) return step;
    }
  }
}

}  // namespace

Range usable(const Range& range) {
  if (!std::isfinite(range.low) || !std::isfinite(range.high) || range.low > range.high) return {};
  if (!std::isfinite(range.span())) return {};
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  // Ticks closer than this to each other cannot be told apart as doubles.
  if (range.span() > 1e-9 * size && range.span() > 1e-300) return range;
  const double room = size > 0.0 ? 0.05 * size : 0.5;
  return {range.low - room, range.high + room};
}

Range padded_by(const Range& range, double share) {
  return {range.low - share * range.span(), range.high + share * range.span()};
}

Ticks nice_ticks(const Range& any_range, int most) {
  const Range range = usable(any_range);
  int exponent = 0;
  const double step = step_for(range, most, &exponent);
  Ticks ticks;
  ticks.decimals = std::clamp(-exponent, 0, 12);
  const double last = last_multiple(range, step);
  for (double i = first_multiple(range, step); i <= last; i += 1.0) {
    ticks.values.push_back(i == 0.0 ? 0.0 : i * step);
  }
  return ticks;
}

Ticks log_ticks(const Range& range, int most) {
  std::vector<double> fine;
  std::vector<double> powers;
  for (int power = exponent_of(range.low); power <= exponent_of(range.high); ++power) {
    for (const double mantissa : kMantissas) {
      const double value = mantissa * power_of_ten(power);
      if (value < range.low * (1.0 - kSlack) || value > range.high * (1.0 + kSlack)) continue;
      fine.push_back(value);
      if (mantissa == 1.0) powers.push_back(value);
    }
  }
  const auto limit = static_cast<std::size_t>(most);
  if (fine.size() <= limit || powers.size() < 2) return {fine, std::nullopt};
  const std::size_t stride = (powers.size() + limit - 1) / limit;
  Ticks ticks;
  for (std::size_t i = 0; i < powers.size(); i += stride) ticks.values.push_back(powers[i]);
  return ticks;
}

std::string tick_text(double value, const Ticks& ticks) {
  char text[40];
  const bool fixed = ticks.decimals && *ticks.decimals <= 6 && std::abs(value) < 1e7;
  if (fixed) {
    std::snprintf(text, sizeof text, "%.*f", *ticks.decimals, std::abs(value));
  } else {
    std::snprintf(text, sizeof text, "%.6g", std::abs(value));
  }
  return value < 0.0 ? "\xE2\x88\x92" + std::string(text) : text;
}

double nice_below(double limit) {
  const double power = power_of_ten(exponent_of(limit));
  double best = power;
  for (const double mantissa : kMantissas) {
    if (mantissa * power <= limit * (1.0 + kSlack)) best = mantissa * power;
  }
  return best;
}

}  // namespace overfly::server::plot
