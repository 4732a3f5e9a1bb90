#include "core/earth/magnetic_field.hpp"

#include <GeographicLib/SphericalHarmonic.hpp>
#include <algorithm>
#include <vector>

#include "core/earth/wmm2025.hpp"
#include "core/time.hpp"

namespace overfly {
namespace {

constexpr double kReferenceRadiusM = 6371200.0;
constexpr double kValidYears = 5.0;
constexpr std::int64_t kEpochUnixS = 1'735'689'600;  // 2025-01-01T00:00:00Z
constexpr double kSecondsPerYear = 365.25 * 86400.0;

double years_since_epoch(std::int64_t unix_ns) {
  const double s = s_from_ns(unix_ns) - static_cast<double>(kEpochUnixS);
  return std::clamp(s / kSecondsPerYear, 0.0, kValidYears);
}

}  // namespace

struct MagneticField::Potential {
  explicit Potential(double years)
      : cosines(coefficients(years, true)),
        sines(coefficients(years, false)),
        sum(cosines,
            sines,
            wmm2025::kDegree,
            kReferenceRadiusM,
            GeographicLib::SphericalHarmonic::SCHMIDT) {}

  /// In the library's order: by order, then by degree. Sines begin at order 1.
  static std::vector<double> coefficients(double years, bool of_cosines) {
    std::vector<double> sorted;
    const int first_order = of_cosines ? 0 : 1;
    if (of_cosines) sorted.push_back(0.0);  // degree 0: no magnetic monopole
    for (int order = first_order; order <= wmm2025::kDegree; ++order) {
      for (const wmm2025::Term& term : wmm2025::kTerms) {
        if (term.order != order) continue;
        sorted.push_back(of_cosines ? term.g_nt + years * term.g_nt_year
                                    : term.h_nt + years * term.h_nt_year);
      }
    }
    return sorted;
  }

  std::vector<double> cosines;
  std::vector<double> sines;
  GeographicLib::SphericalHarmonic sum;  ///< refers to both
};

MagneticField::MagneticField(std::int64_t unix_ns)
    : potential_(std::make_unique<const Potential>(years_since_epoch(unix_ns))) {}
MagneticField::~MagneticField() = default;
MagneticField::MagneticField(MagneticField&& other) noexcept = default;
MagneticField& MagneticField::operator=(MagneticField&& other) noexcept = default;

Eigen::Vector3d MagneticField::ned_ut(const Geodetic& place) const {
  const Eigen::Vector3d p = ecef_from_geodetic(place);
  Eigen::Vector3d gradient;
  potential_->sum(p.x(), p.y(), p.z(), gradient.x(), gradient.y(), gradient.z());
  constexpr double kUtPerNt = 1e-3;
  const Eigen::Vector3d field_ecef = -kReferenceRadiusM * kUtPerNt * gradient;
  const LocalFrame here(place);
  const Eigen::Vector3d enu = here.world_from_ecef(p + field_ecef);
  return {enu.y(), enu.x(), -enu.z()};
}

}  // namespace overfly
