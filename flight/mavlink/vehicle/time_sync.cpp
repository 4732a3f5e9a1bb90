#include "flight/mavlink/vehicle/time_sync.hpp"

#include <algorithm>
#include <cmath>

#include "core/time.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::size_t kAnswersInUse = 32;
constexpr std::size_t kFewestAnswers = 4;
constexpr std::int64_t kShortestSpanNs = kNsPerS / 5;
constexpr std::int64_t kLongestRoundTripNs = 10 * kNsPerS;
constexpr std::int64_t kSurpriseNs = kNsPerS;
/// 100 years: differences cannot overflow.
constexpr std::int64_t kLatestTimeNs = 100LL * 366 * 86400 * kNsPerS;
/// Added to a round trip, so that one answer of a fast link does not outweigh all others.
constexpr double kJitterS = 1e-4;

}  // namespace

void TimeSync::take(std::int64_t sent_ns, std::int64_t vehicle_ns, std::int64_t received_ns) {
  if (vehicle_ns < 0 || vehicle_ns > kLatestTimeNs || sent_ns < 0 || received_ns < sent_ns ||
      received_ns > kLatestTimeNs || received_ns - sent_ns > kLongestRoundTripNs) {
    return;
  }
  const std::int64_t round_trip_ns = received_ns - sent_ns;
  const Answer answer{sent_ns + round_trip_ns / 2, vehicle_ns, round_trip_ns};
  const bool back = !answers_.empty() && (vehicle_ns < answers_.back().vehicle_ns - kSurpriseNs ||
                                          answer.local_ns < answers_.back().local_ns);
  const std::optional<std::int64_t> expected_ns = vehicle_ns_at(answer.local_ns);
  if (back || (expected_ns && std::abs(*expected_ns - vehicle_ns) > kSurpriseNs)) {
    answers_.clear();
    fitted_ = false;
    ++restarts_;
  }
  answers_.push_back(answer);
  if (answers_.size() > kAnswersInUse) answers_.pop_front();
  fit();
}

void TimeSync::fit() {
  const Answer& first = answers_.front();
  if (answers_.size() < kFewestAnswers ||
      answers_.back().local_ns - first.local_ns < kShortestSpanNs) {
    return;
  }
  double weights = 0.0;
  double mean_x_s = 0.0;
  double mean_y_s = 0.0;
  const auto weight_of = [](const Answer& answer) {
    const double spread_s = s_from_ns(answer.round_trip_ns) + kJitterS;
    return 1.0 / (spread_s * spread_s);
  };
  for (const Answer& answer : answers_) {
    const double weight = weight_of(answer);
    weights += weight;
    mean_x_s += weight * s_from_ns(answer.local_ns - first.local_ns);
    mean_y_s += weight * s_from_ns(answer.vehicle_ns - first.vehicle_ns);
  }
  mean_x_s /= weights;
  mean_y_s /= weights;
  double xx = 0.0;
  double xy = 0.0;
  for (const Answer& answer : answers_) {
    const double x_s = s_from_ns(answer.local_ns - first.local_ns) - mean_x_s;
    const double y_s = s_from_ns(answer.vehicle_ns - first.vehicle_ns) - mean_y_s;
    xx += weight_of(answer) * x_s * x_s;
    xy += weight_of(answer) * x_s * y_s;
  }
  if (xx <= 0.0) return;
  rate_ = xy / xx;
  base_local_ns_ = first.local_ns + ns_from_s(mean_x_s);
  base_vehicle_ns_ = first.vehicle_ns + ns_from_s(mean_y_s);
  fitted_ = true;
}

std::optional<std::int64_t> TimeSync::vehicle_ns_at(std::int64_t local_ns) const {
  if (!fitted_) return std::nullopt;
  return base_vehicle_ns_ + ns_from_s(rate_ * s_from_ns(local_ns - base_local_ns_));
}

std::optional<std::int64_t> TimeSync::round_trip_ns() const {
  if (answers_.empty()) return std::nullopt;
  const auto shortest =
      std::min_element(answers_.begin(), answers_.end(), [](const Answer& a, const Answer& b) {
        return a.round_trip_ns < b.round_trip_ns;
      });
  return shortest->round_trip_ns;
}

}  // namespace overfly::flight::mavlink
