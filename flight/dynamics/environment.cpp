#include "flight/dynamics/environment.hpp"

#include <algorithm>
#include <cmath>

#include "flight/gravity.hpp"

namespace overfly::dynamics {

StandardAir standard_air(double alt_msl_m) {
  // Constants of the U.S. Standard Atmosphere 1976, tables 2 to 4.
  constexpr double kEarthRadiusM = 6356766.0;
  constexpr double kGasConstant = 8314.32 / 28.9644;  // J/(kg K)
  constexpr double kSeaLevelK = 288.15;
  constexpr double kSeaLevelPa = 101325.0;
  constexpr double kLapseKM = -0.0065;
  constexpr double kTropopauseM = 11000.0;
  constexpr double kTropopauseK = kSeaLevelK + kLapseKM * kTropopauseM;
  constexpr double kExponent = -kStandardGravityMS2 / (kGasConstant * kLapseKM);
  const double z_m = std::clamp(alt_msl_m, -5000.0, 20000.0);
  const double h_m = kEarthRadiusM * z_m / (kEarthRadiusM + z_m);
  StandardAir air;
  if (h_m <= kTropopauseM) {
    const double ratio = 1.0 + kLapseKM / kSeaLevelK * h_m;
    air.temperature_k = kSeaLevelK * ratio;
    air.pressure_pa = kSeaLevelPa * std::pow(ratio, kExponent);
    air.density_kg_m3 =
        kSeaLevelPa / (kGasConstant * kSeaLevelK) * std::pow(ratio, kExponent - 1.0);
    return air;
  }
  const double decay =
      std::exp(-kStandardGravityMS2 * (h_m - kTropopauseM) / (kGasConstant * kTropopauseK));
  constexpr double kRatio = kTropopauseK / kSeaLevelK;
  air.temperature_k = kTropopauseK;
  air.pressure_pa = kSeaLevelPa * std::pow(kRatio, kExponent) * decay;
  air.density_kg_m3 =
      kSeaLevelPa / (kGasConstant * kSeaLevelK) * std::pow(kRatio, kExponent - 1.0) * decay;
  return air;
}

double standard_density_kg_m3(double alt_msl_m) { return standard_air(alt_msl_m).density_kg_m3; }

Environment Environment::at(const Geodetic& origin, double alt_msl_at_origin_m) {
  Environment environment;
  environment.gravity_m_s2 = flight::normal_gravity_m_s2(origin);
  environment.alt_msl_at_origin_m = alt_msl_at_origin_m;
  return environment;
}

}  // namespace overfly::dynamics
