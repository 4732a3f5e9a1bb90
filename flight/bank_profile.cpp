#include "flight/bank_profile.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::flight {

BankChange::BankChange(double from_rad, double to_rad, double rate_max_rad_s)
    : from_rad_(from_rad),
      to_rad_(to_rad),
      rate_rad_s_(std::copysign(rate_max_rad_s, to_rad - from_rad)) {
  // The area under a rate that ramps up, stays and ramps down is rate * (ramp + plateau).
  const double at_full_rate_s = std::abs(to_rad - from_rad) / rate_max_rad_s;
  ramp_s_ = std::min(kRollRampS, at_full_rate_s);
  plateau_s_ = at_full_rate_s - ramp_s_;
}

BankSample BankChange::at(double t_s) const {
  if (t_s <= 0.0) return {from_rad_, 0.0};
  if (t_s >= duration_s()) return {to_rad_, 0.0};
  const auto ramp = [this](double u_s) {
    const double phase = kPi * u_s / ramp_s_;
    return BankSample{0.5 * rate_rad_s_ * (u_s - ramp_s_ / kPi * std::sin(phase)),
                      0.5 * rate_rad_s_ * (1.0 - std::cos(phase))};
  };
  if (t_s < ramp_s_) {
    const BankSample up = ramp(t_s);
    return {from_rad_ + up.bank_rad, up.rate_rad_s};
  }
  if (t_s <= ramp_s_ + plateau_s_) {
    return {from_rad_ + rate_rad_s_ * (t_s - 0.5 * ramp_s_), rate_rad_s_};
  }
  const BankSample down = ramp(duration_s() - t_s);
  return {to_rad_ - down.bank_rad, down.rate_rad_s};
}

void BankProfile::roll_to(double bank_rad) {
  const double from_rad = pieces_.empty() ? 0.0 : pieces_.back().change.to_rad();
  pieces_.push_back({end_s_, BankChange(from_rad, bank_rad, rate_max_rad_s_)});
  end_s_ += pieces_.back().change.duration_s();
}

BankSample BankProfile::at(double t_s) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), t_s, [](double t, const Piece& piece) {
        return t < piece.begin_s;
      });
  if (after == pieces_.begin()) return {};
  const Piece& piece = *std::prev(after);
  return piece.change.at(t_s - piece.begin_s);
}

}  // namespace overfly::flight
