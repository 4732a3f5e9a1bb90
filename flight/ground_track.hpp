// Ground track of an aircraft in coordinated turns. Private to flight.
#pragma once

#include <vector>

#include "flight/bank_profile.hpp"

namespace overfly::flight {

/// Standard gravity [m/s2] (CGPM 1901).
inline constexpr double kGravityMS2 = 9.80665;

struct GroundSample {
  double east_m = 0.0;
  double north_m = 0.0;
  double heading_rad = 0.0;  ///< clockwise from north, not wrapped
  double heading_rate_rad_s = 0.0;
};

/// Turn rate of a coordinated level turn: g tan(bank) / V [rad/s].
[[nodiscard]] double turn_rate_rad_s(double bank_rad, double speed_m_s);

/// Integrates heading and position of a bank profile at constant ground speed. Nodes are stored
/// every 10 ms. Between nodes, 3-point Gauss-Legendre quadrature from the previous node keeps the
/// track as smooth as the bank (continuous at the nodes up to rounding).
class GroundTrack {
 public:
  GroundTrack(BankProfile bank, double speed_m_s, const GroundSample& start, double duration_s);

  [[nodiscard]] double duration_s() const { return duration_s_; }
  [[nodiscard]] BankSample bank_at(double t_s) const { return bank_.at(t_s); }
  /// Outside [0, duration] the track continues straight along the heading of the end.
  [[nodiscard]] GroundSample at(double t_s) const;

 private:
  [[nodiscard]] double heading_after(const GroundSample& node, double node_s, double dt_s) const;
  [[nodiscard]] GroundSample step(const GroundSample& node, double node_s, double dt_s) const;

  BankProfile bank_;
  double speed_m_s_;
  double duration_s_;
  std::vector<GroundSample> nodes_;
};

}  // namespace overfly::flight
