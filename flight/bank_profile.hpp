// The bank angle over time: holds joined by smooth changes. Private to flight.
#pragma once

#include <vector>

namespace overfly::flight {

/// Roll rates rise and fall as raised cosines of this length, shorter where the change of bank is
/// too small for the rate's limit to be reached otherwise [s].
inline constexpr double kRollRampS = 0.5;

struct BankSample {
  double bank_rad = 0.0;
  double rate_rad_s = 0.0;
};

/// One change of bank from t = 0: the rate rises to its limit as a raised cosine, stays, and
/// falls as it rose. The rate reaches the limit whatever the change; bank is twice continuously
/// differentiable, roll acceleration continuous.
class BankChange {
 public:
  BankChange(double from_rad, double to_rad, double rate_max_rad_s);

  [[nodiscard]] double duration_s() const { return 2.0 * ramp_s_ + plateau_s_; }
  /// @param t_s  from the begin; held at the ends outside [0, duration]
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
  /// Level before the first change, held after the last.
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
