#include "sensor/sensor_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sensor/number_limit.hpp"

namespace overfly::sensor {

namespace {

Status check_table(const std::vector<double>& table) {
  const auto invalid = [](const std::string& text) {
    return Error{ErrorCode::kInvalidArgument, "response.table: " + text};
  };
  if (table.size() < 2) {
    return invalid("has " + std::to_string(table.size()) + " values: at least 2 are required");
  }
  if (table.front() != 0.0 || table.back() != 1.0) {
    return invalid("runs from " + rounded_text(table.front()) + " to " +
                   rounded_text(table.back()) + ": must run from 0 to 1");
  }
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (!(table[i] > table[i - 1])) {
      return invalid("value " + std::to_string(i) + " = " + rounded_text(table[i]) +
                     ": must be larger than the previous value, " + rounded_text(table[i - 1]));
    }
  }
  return {};
}

Status check_response(const ResponseCurve& response) {
  if (response.shape == ResponseShape::kTable) return check_table(response.table);
  if (response.shape == ResponseShape::kGamma) {
    return check_limits({{"response.gamma", response.gamma, 0.1, 10.0}});
  }
  return {};
}

Status check_auto_exposure(const AutoExposure& automatic) {
  return check_limits({
      {"auto_exposure.target_mean", automatic.target_mean, 0.01, 0.95},
      {"auto_exposure.min_exposure_s", automatic.min_exposure_s, 1e-6, 1.0},
      {"auto_exposure.max_exposure_s", automatic.max_exposure_s, automatic.min_exposure_s, 1.0},
      {"auto_exposure.max_gain", automatic.max_gain, 1.0, 1e4},
      {"auto_exposure.settle_frames", static_cast<double>(automatic.settle_frames), 4, 1000},
  });
}

}  // namespace

double Vignette::transmission(double r) const {
  const double r2 = r * r;
  return 1.0 + r2 * (a[0] + r2 * (a[1] + r2 * a[2]));
}

Status SensorModel::validate() const {
  Status numbers = check_limits({
      {"defocus_sigma_px", defocus_sigma_px, 0.0, 50.0},
      {"exposure_s", exposure_s, 1e-6, 1.0},
      {"readout_s", readout_s, 0.0, 1.0},
      {"electrons_per_s", electrons_per_s, 1.0, 1e12},
      {"prnu", prnu, 0.0, 0.5},
      {"dsnu_e", dsnu_e, 0.0, 1e6},
      {"full_well_e", full_well_e, 0.0, 1e7},
      {"read_noise_e", read_noise_e, 0.0, 1e6},
      {"gain_dn_per_e", gain_dn_per_e, 0.0, 1e5},
      {"bits", static_cast<double>(bits), 8, 16},
      {"black_level_dn", black_level_dn, 0.0, 0.5 * ((1 << std::clamp(bits, 8, 16)) - 1)},
  });
  if (!numbers) return numbers;
  if (adc_bits != 0) {
    const NumberLimit limit{
        "adc_bits", static_cast<double>(adc_bits), static_cast<double>(bits), 16};
    if (Status status = check_limits({limit}); !status) return status;
  }
  if (vignette && !(std::isfinite(vignette->transmission(1.0)))) {
    return Error{ErrorCode::kInvalidArgument, "vignette: a coefficient is not finite"};
  }
  if (Status status = check_response(response); !status) return status;
  return auto_exposure ? check_auto_exposure(*auto_exposure) : Status();
}

double SensorModel::effective_gain_dn_per_e() const {
  if (gain_dn_per_e > 0.0) return gain_dn_per_e;
  double full_scale_e = electrons_per_s * exposure_s;
  if (full_well_e > 0.0) full_scale_e = std::min(full_scale_e, full_well_e);
  return ((1 << bits) - 1 - black_level_dn) / full_scale_e;
}

int SensorModel::effective_adc_bits() const {
  if (adc_bits != 0) return adc_bits;
  return response.is_linear() ? bits : std::min(bits + 4, 16);
}

}  // namespace overfly::sensor
