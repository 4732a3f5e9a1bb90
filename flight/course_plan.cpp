#include "flight/course_plan.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"
#include "flight/ground_track.hpp"

namespace overfly::flight {
namespace {

constexpr double kSwingMinRad = rad_from_deg(30.0);
constexpr double kSwingMaxRad = rad_from_deg(100.0);
constexpr double kReversalMaxRad = rad_from_deg(45.0);

/// The x in [low, high] where a decreasing function equals `wanted`; otherwise the nearer end.
template <typename Function>
double bisect_decreasing(double low, double high, double wanted, const Function& function) {
  if (function(low) <= wanted) return low;
  if (function(high) >= wanted) return high;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Geometry of turns at a given bank, speed and roll rate.
class Turns {
 public:
  Turns(const CourseParameters& p, double bank_rad)
      : speed_m_s_(p.airspeed_m_s), roll_rate_(p.roll_rate_max_rad_s), bank_rad_(bank_rad) {}

  [[nodiscard]] double bank_rad() const { return bank_rad_; }
  [[nodiscard]] double rate_rad_s() const { return turn_rate_rad_s(bank_rad_, speed_m_s_); }
  /// Heading gained while rolling from level to the bank.
  [[nodiscard]] double roll_in_rad() const {
    const BankChange change(0.0, bank_rad_, roll_rate_);
    return heading_change(change, 0.0, change.duration_s());
  }
  [[nodiscard]] double roll_in_s() const {
    return BankChange(0.0, bank_rad_, roll_rate_).duration_s();
  }
  /// Heading change from wings level to full bank in a reversal; the first half loses as much.
  [[nodiscard]] double half_reversal_rad() const {
    const BankChange change(-bank_rad_, bank_rad_, roll_rate_);
    return heading_change(change, 0.5 * change.duration_s(), change.duration_s());
  }
  /// Time at full bank between two reversals, so that the heading goes from one side of the swing
  /// to the other.
  [[nodiscard]] double hold_s(double swing_rad) const {
    return std::max(0.0, 2.0 * (swing_rad - half_reversal_rad()) / rate_rad_s());
  }
  /// Ratio of distance made good to distance flown in one swing: the mean cosine of the heading
  /// offset.
  [[nodiscard]] double progress(double swing_rad) const {
    BankProfile bank(roll_rate_);
    bank.roll_to(-bank_rad_);
    const double swing_begin_s = bank.end_s();
    bank.roll_to(bank_rad_);
    bank.hold(hold_s(swing_rad));
    bank.roll_to(-bank_rad_);
    const double reversal_s = BankChange(-bank_rad_, bank_rad_, roll_rate_).duration_s();
    const double from_s = swing_begin_s + 0.5 * reversal_s;
    const double to_s = bank.end_s() - 0.5 * reversal_s;
    const double before_s = from_s;  // the track starts level; rotate it to start at -swing
    const GroundTrack probe(bank, speed_m_s_, {}, to_s);
    const double turn_back_rad = -swing_rad - probe.at(before_s).heading_rad;
    const GroundTrack track(bank, speed_m_s_, {0.0, 0.0, turn_back_rad, 0.0}, to_s);
    return (track.at(to_s).north_m - track.at(from_s).north_m) / (speed_m_s_ * (to_s - from_s));
  }

 private:
  [[nodiscard]] double heading_change(const BankChange& change, double from_s, double to_s) const {
    // Simpson's rule; the integrand is smooth, so 200 intervals are exact to rounding.
    constexpr int kIntervals = 200;
    const double h_s = (to_s - from_s) / kIntervals;
    double sum = 0.0;
    for (int i = 0; i <= kIntervals; ++i) {
      const double weight = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
      sum += weight * turn_rate_rad_s(change.at(from_s + i * h_s).bank_rad, speed_m_s_);
    }
    return sum * h_s / 3.0;
  }

  double speed_m_s_;
  double roll_rate_;
  double bank_rad_;
};

double course_bank_rad(const CourseParameters& p) {
  const double tightest_rad =
      std::atan(p.airspeed_m_s * p.airspeed_m_s / (kGravityMS2 * kTurnRadiusMinM));
  const double limit_rad = std::min(p.bank_max_rad, tightest_rad);
  return bisect_decreasing(1e-6, limit_rad, -kReversalMaxRad, [&](double bank_rad) {
    return -Turns(p, bank_rad).half_reversal_rad();
  });
}

/// The swing amplitude at which the flight ends next to its start.
double swing_for(const CourseParameters& p, const Turns& turns) {
  BankProfile turn(p.roll_rate_max_rad_s);
  turn.roll_to(turns.bank_rad());
  const double turn_s = turns.roll_in_s() + (kPi - turns.roll_in_rad()) / turns.rate_rad_s();
  const double ahead_m = GroundTrack(turn, p.airspeed_m_s, {}, turn_s).at(turn_s).north_m;
  const double back_m = p.leg_length_m + ahead_m;
  const double left_m = p.length_m - p.leg_length_m - turn_s * p.airspeed_m_s;
  const double wanted = left_m > 0.0 ? back_m / left_m : 1.0;
  return bisect_decreasing(
      std::max(kSwingMinRad, turns.half_reversal_rad()), kSwingMaxRad, wanted, [&](double swing) {
        return turns.progress(swing);
      });
}

}  // namespace

BankProfile plan_course(const CourseParameters& p) {
  const Turns turns(p, course_bank_rad(p));
  const double swing_rad = swing_for(p, turns);
  const double end_s = p.length_m / p.airspeed_m_s;

  BankProfile bank(p.roll_rate_max_rad_s);
  bank.hold(p.leg_length_m / p.airspeed_m_s);
  bank.roll_to(turns.bank_rad());
  // Continue to the far side of the first swing, where the reversal crosses wings level.
  const double first_rad = kPi + swing_rad - turns.roll_in_rad() - turns.half_reversal_rad();
  bank.hold(first_rad / turns.rate_rad_s());
  for (double side = -1.0; bank.end_s() < end_s; side = -side) {
    bank.roll_to(side * turns.bank_rad());
    bank.hold(turns.hold_s(swing_rad));
  }
  return bank;
}

}  // namespace overfly::flight
