// The earth's magnetic field.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "core/earth/geodesy.hpp"

namespace overfly {

/// The main field at a date, by the World Magnetic Model 2025 (degree and order 12).
///
/// The model is valid from 2025 to 2030; an earlier or later date gets the field of the nearer end.
/// It contains neither the crust's field nor daily variations, typically 0.1 uT each. Immutable
/// after construction: calls are thread-safe.
class MagneticField {
 public:
  /// @param unix_ns  the date
  explicit MagneticField(std::int64_t unix_ns);
  ~MagneticField();
  MagneticField(MagneticField&& other) noexcept;
  MagneticField& operator=(MagneticField&& other) noexcept;

  /// Flux density in the local north-east-down axes [uT].
  ///
  /// Method: the gradient of the potential of "The US/UK World Magnetic Model for 2025-2030",
  /// eq. 4, in earth-centred coordinates, with the coefficients of eq. 9.
  [[nodiscard]] Eigen::Vector3d ned_ut(const Geodetic& place) const;

 private:
  struct Potential;
  std::unique_ptr<const Potential> potential_;
};

}  // namespace overfly
