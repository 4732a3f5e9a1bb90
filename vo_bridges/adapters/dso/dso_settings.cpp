#include "vo_bridges/adapters/dso/dso_settings.hpp"

#include <util/globalCalib.h>
#include <util/settings.h>

#include <cmath>
#include <stdexcept>

namespace overfly_adapters {
namespace {

/// Same as mode=N in DSO's command line.
void set_photometric_mode(int mode) {
  dso::setting_photometricCalibration = mode == 0 ? 2 : 0;
  const std::array<float, 3> affine_a = {{1e12F, 0.0F, -1.0F}};
  const std::array<float, 3> affine_b = {{1e8F, 0.0F, -1.0F}};
  dso::setting_affineOptModeA = affine_a[static_cast<std::size_t>(mode)];
  dso::setting_affineOptModeB = affine_b[static_cast<std::size_t>(mode)];
  dso::setting_minGradHistAdd = mode == 2 ? 3.0F : 7.0F;
}

/// A float as the decimal it was parsed from, within seven digits.
double single(float value) {
  const double scale = std::pow(10.0, 6.0 - std::floor(std::log10(std::fabs(value) + 1e-30)));
  return std::round(static_cast<double>(value) * scale) / scale;
}

}  // namespace

void write_dso_settings(const Session& session) {
  const ParameterValues& values = session.parameters;
  // With logging enabled DSO would remove the folders logs and mats in its working folder.
  dso::setting_logStuff = false;
  dso::setting_debugout_runquiet = true;
  dso::disableAllDisplay = true;
  dso::multiThreading = flag_of(values, "multiThreading", !session.lockstep);
  // Set the mode first, so that it does not overwrite parameters requested by name.
  set_photometric_mode(static_cast<int>(number_of(values, "mode")));
  if (values.at("setting_minGradHistAdd") != "auto") {
    dso::setting_minGradHistAdd = static_cast<float>(number_of(values, "setting_minGradHistAdd"));
  }
  const auto number = [&](const char* name) { return static_cast<float>(number_of(values, name)); };
  const auto whole = [&](const char* name) { return static_cast<int>(number_of(values, name)); };
  dso::setting_minGradHistCut = number("setting_minGradHistCut");
  dso::setting_desiredImmatureDensity = number("setting_desiredImmatureDensity");
  dso::setting_desiredPointDensity = number("setting_desiredPointDensity");
  dso::setting_kfGlobalWeight = number("setting_kfGlobalWeight");
  dso::setting_minFrames = whole("setting_minFrames");
  dso::setting_maxFrames = whole("setting_maxFrames");
  dso::setting_maxOptIterations = whole("setting_maxOptIterations");
  dso::setting_minOptIterations = whole("setting_minOptIterations");
}

void set_dso_camera(const AdapterCamera& camera) {
  if (camera.distortion != "none") {
    throw std::runtime_error("distortion " + camera.distortion +
                             ": DSO takes rectified images only (distortion none)");
  }
  Eigen::Matrix3f K = Eigen::Matrix3f::Identity();
  K(0, 0) = static_cast<float>(camera.fx_px);
  K(1, 1) = static_cast<float>(camera.fy_px);
  // In both systems the centre of a pixel is at integers here. DSO subtracts half a pixel from the
  // centre in calibration files (whose origin is the corner); this must not be repeated.
  K(0, 2) = static_cast<float>(camera.cx_px);
  K(1, 2) = static_cast<float>(camera.cy_px);
  dso::setGlobalCalib(camera.width_px, camera.height_px, K);
  if (dso::wG[0] != camera.width_px || dso::hG[0] != camera.height_px ||
      dso::benchmarkSetting_width != 0 || dso::benchmarkSetting_height != 0) {
    throw std::runtime_error("DSO has resized the frames from " + std::to_string(camera.width_px) +
                             " x " + std::to_string(camera.height_px) + " to " +
                             std::to_string(dso::wG[0]) + " x " + std::to_string(dso::hG[0]) +
                             ": the run's camera would not be the scenario's");
  }
  if (dso::pyrLevelsUsed < 3) {
    throw std::runtime_error("frames of " + std::to_string(camera.width_px) + " x " +
                             std::to_string(camera.height_px) +
                             " px: DSO needs 3 levels of exact"
                             " halving; use a size divisible by 8, at least 160 x 120");
  }
}

ParameterValues read_dso_settings() {
  ParameterValues values;
  values["multiThreading"] = text_of_flag(dso::multiThreading);
  const auto tell = [&](const char* name, double value) { values[name] = text_of_number(value); };
  tell("setting_minGradHistAdd", dso::setting_minGradHistAdd);
  tell("setting_minGradHistCut", single(dso::setting_minGradHistCut));
  tell("setting_desiredImmatureDensity", dso::setting_desiredImmatureDensity);
  tell("setting_desiredPointDensity", dso::setting_desiredPointDensity);
  tell("setting_kfGlobalWeight", single(dso::setting_kfGlobalWeight));
  tell("setting_minFrames", dso::setting_minFrames);
  tell("setting_maxFrames", dso::setting_maxFrames);
  tell("setting_maxOptIterations", dso::setting_maxOptIterations);
  tell("setting_minOptIterations", dso::setting_minOptIterations);
  tell("setting_photometricCalibration", dso::setting_photometricCalibration);
  tell("setting_affineOptModeA", dso::setting_affineOptModeA);
  tell("setting_affineOptModeB", dso::setting_affineOptModeB);
  tell("wG", dso::wG[0]);
  tell("hG", dso::hG[0]);
  tell("fxG", single(dso::fxG[0]));
  tell("fyG", single(dso::fyG[0]));
  tell("cxG", single(dso::cxG[0]));
  tell("cyG", single(dso::cyG[0]));
  return values;
}

}  // namespace overfly_adapters
