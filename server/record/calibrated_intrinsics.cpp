#include "server/record/calibrated_intrinsics.hpp"

#include <cstdio>

#include "server/record/rows/run_rows.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Of a distortion's coefficients, as they are written.
Json coefficients_json(const std::array<double, 5>& k, DistortionModel model) {
  Json values = Json::array();
  for (int i = 0; i < coefficient_count(model); ++i) {
    values.push_back(k[static_cast<std::size_t>(i)]);
  }
  return values;
}

Json difference_json(const CalibratedIntrinsics& intrinsics, const CameraModel& truth) {
  const PinholeCamera& given = intrinsics.model.pinhole();
  const PinholeCamera& real = truth.pinhole();
  return {{"fx_px", given.fx_px - real.fx_px},
          {"fy_px", given.fy_px - real.fy_px},
          {"cx_px", given.cx_px - real.cx_px},
          {"cy_px", given.cy_px - real.cy_px},
          {"projection_mean_px", intrinsics.mean_difference_px},
          {"projection_max_px", intrinsics.max_difference_px}};
}

std::string formatted(const char* format, double value) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

}  // namespace

Json json_from(const CalibratedIntrinsics& intrinsics, const CameraModel& truth) {
  const CalibratedIntrinsics::Deviation& noise = intrinsics.deviation;
  Json value = json_from(intrinsics.model);
  value["standard_deviation"] = {
      {"fx_px", noise.fx_px},
      {"fy_px", noise.fy_px},
      {"cx_px", noise.cx_px},
      {"cy_px", noise.cy_px},
      {"coefficients", coefficients_json(noise.k, intrinsics.model.distortion().model)}};
  value["rms_px"] = intrinsics.rms_px;
  value["views"] = intrinsics.views;
  value["difference"] = difference_json(intrinsics, truth);
  return value;
}

CalibratedIntrinsics read_calibrated_intrinsics(const FileField& field) {
  CalibratedIntrinsics intrinsics;
  const Result<CameraModel> model = camera_model_from(field.value());
  if (!model) field.reject("be a camera (" + model.error().message + ")");
  intrinsics.model = *model;
  const FileField noise = field.at("standard_deviation");
  const auto count =
      static_cast<std::size_t>(coefficient_count(intrinsics.model.distortion().model));
  const std::vector<double> k = noise.at("coefficients").numbers(count);
  CalibratedIntrinsics::Deviation& deviation = intrinsics.deviation;
  deviation.fx_px = noise.at("fx_px").number();
  deviation.fy_px = noise.at("fy_px").number();
  deviation.cx_px = noise.at("cx_px").number();
  deviation.cy_px = noise.at("cy_px").number();
  for (std::size_t i = 0; i < count; ++i) deviation.k[i] = k[i];
  intrinsics.rms_px = field.at("rms_px").number();
  intrinsics.views = static_cast<int>(field.at("views").integer(0, 1'000'000));
  const FileField difference = field.at("difference");
  intrinsics.mean_difference_px = difference.at("projection_mean_px").number();
  intrinsics.max_difference_px = difference.at("projection_max_px").number();
  return intrinsics;
}

std::string calibrated_words(const CalibratedIntrinsics& intrinsics, const CameraModel& truth) {
  const PinholeCamera& given = intrinsics.model.pinhole();
  const PinholeCamera& real = truth.pinhole();
  std::string text;
  const auto add = [&](const char* name, double value, double noise, double true_value) {
    text += (text.empty() ? "" : ", ") + std::string(name) + " " + formatted("%.3f", value) +
            " +- " + formatted("%.3f", noise) + " (true " + formatted("%.3f", true_value) + ")";
  };
  const CalibratedIntrinsics::Deviation& noise = intrinsics.deviation;
  add("fx", given.fx_px, noise.fx_px, real.fx_px);
  add("fy", given.fy_px, noise.fy_px, real.fy_px);
  add("cx", given.cx_px, noise.cx_px, real.cx_px);
  add("cy", given.cy_px, noise.cy_px, real.cy_px);
  return text + " px, lens " + to_string(intrinsics.model.distortion().model) + ", from " +
         std::to_string(intrinsics.views) + " views; projections differ from the true ones by " +
         formatted("%.3f", intrinsics.mean_difference_px) + " px on average, " +
         formatted("%.3f", intrinsics.max_difference_px) + " px at most";
}

}  // namespace overfly::server
