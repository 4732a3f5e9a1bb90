// The bank angle over time: constant holds joined by smooth changes. Private to flight.
#pragma once

#include <vector>

namespace overfly::flight {

/// Length of the raised-cosine ramps of the roll rate [s]. Shorter if the change of bank is too
/// small to reach the rate limit otherwise.
inline constexpr double kRollRampS = 0.5;

struct BankSample {
  double bank_rad = 0.0;
  double rate_rad_s = 0.0;
};

/// One change of bank from t = 0. The rate rises to its limit as a raised cosine, stays constant,
/// and falls symmetrically. Every change reaches the limit. The bank is twice continuously
/// differentiable and the roll acceleration is continuous.
class BankChange {
 public:
  BankChange(double from_rad, double to_rad, double rate_max_rad_s);

  [[nodiscard]] double duration_s() const { return 2.0 * ramp_s_ + plateau_s_; }
  /// @param t_s  time from the start; outside [0, duration] the end values are returned
  [[nodiscard]] BankSample at(double t_s) const;
  [[nodiscard]] double to_rad() const { return to_rad_; }

 private:
  double from_rad_;
  double to_rad_;
  double rate_rad_s_;  // signed
  double ramp_s_;
  double plateau_s_;
};

class BankProfile {
 public:
  explicit BankProfile(double roll_rate_max_rad_s) : rate_max_rad_s_(roll_rate_max_rad_s) {}

  void hold(double duration_s) { end_s_ += duration_s; }
  void roll_to(double bank_rad);

  [[nodiscard]] double end_s() const { return end_s_; }
  /// Level before the first change; the last bank is held after the last change.
  [[nodiscard]] BankSample at(double t_s) const;

 private:
  struct Piece {
    double begin_s;
    BankChange change;
  };
  double rate_max_rad_s_;
  double end_s_ = 0.0;
  std::vector<Piece> pieces_;
};

}  // namespace overfly::flight
