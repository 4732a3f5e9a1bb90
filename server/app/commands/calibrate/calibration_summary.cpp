#include "server/app/commands/calibrate/calibration_summary.hpp"

#include <cstdio>
#include <vector>

#include "core/motion/pose.hpp"

namespace overfly::app {
namespace {

using server::CalibrationRecord;

std::string estimate_line(const char* name, double value, double deviation, const double* truth) {
  char text[160];
  std::snprintf(text, sizeof text, "  %-3s %14.6f +- %.6f", name, value, deviation);
  std::string line = text;
  if (truth != nullptr) {
    std::snprintf(text, sizeof text, "   true %14.6f, error %+.6f", *truth, value - *truth);
    line += text;
  }
  return line + "\n";
}

std::vector<const char*> parameter_names(const calibration::LensChoice& lens) {
  std::vector<const char*> names = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  if (lens.model == DistortionModel::kEquidistant)
    names = {"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};
  names.resize(static_cast<std::size_t>(lens.parameters()));
  return names;
}

std::string figures_of(const CalibrationRecord& record) {
  const auto values = [](const CameraModel& camera) {
    const PinholeCamera& c = camera.pinhole();
    std::vector<double> all = {c.fx_px, c.fy_px, c.cx_px, c.cy_px};
    all.insert(all.end(), camera.distortion().k.begin(), camera.distortion().k.end());
    return all;
  };
  const calibration::CameraDeviation& d = record.result.deviation;
  std::vector<double> deviations = {d.fx_px, d.fy_px, d.cx_px, d.cy_px};
  deviations.insert(deviations.end(), d.k.begin(), d.k.end());
  const DistortionModel model = record.result.camera.distortion().model;
  const std::vector<const char*> names = parameter_names(record.options.lens);
  const std::vector<double> found = values(record.result.camera);
  // A truth without distortion has coefficients of 0 in every model.
  const bool comparable = record.truth && (record.truth->distortion().none() ||
                                           record.truth->distortion().model == model);
  const std::vector<double> truth = comparable ? values(*record.truth) : std::vector<double>();
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += estimate_line(names[i], found[i], deviations[i], comparable ? &truth[i] : nullptr);
  }
  return text;
}

}  // namespace

std::string calibration_summary(const CalibrationRecord& record) {
  const calibration::Calibration& result = record.result;
  const PinholeCamera& size = result.camera.pinhole();
  char line[256];
  std::snprintf(line,
                sizeof line,
                ": %zu views, %zu images left out; %d x %d px, %s\nRMS %.4f px, largest %.4f px\n",
                record.names.size(),
                record.left_out.size(),
                size.width_px,
                size.height_px,
                to_string(result.camera.distortion().model),
                result.rms_px,
                result.max_px);
  std::string text = record.source + line + figures_of(record) + "coverage";
  for (const calibration::CoverageBar& bar : result.coverage) {
    std::snprintf(line, sizeof line, "  %s %.0f %%", bar.name.c_str(), 100.0 * bar.progress);
    text += line;
  }
  text += "\n  RMS [px]  max [px]  tilt [deg]  view\n";
  for (std::size_t i = 0; i < record.names.size(); ++i) {
    const calibration::CalibratedView& view = result.views[i];
    std::snprintf(line,
                  sizeof line,
                  "%10.4f%10.4f%12.1f  ",
                  view.rms_px,
                  view.max_px,
                  deg_from_rad(view.tilt_rad));
    text += line + record.names[i] + (view.outlier ? " (outlier, left out)" : "") + "\n";
  }
  for (const server::LeftOutImage& image : record.left_out) {
    text += "left out: " + image.name + ": " + image.reason + "\n";
  }
  return text;
}

}  // namespace overfly::app
