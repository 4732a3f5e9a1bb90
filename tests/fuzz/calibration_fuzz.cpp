// Calibration files, as a scenario's camera reads them. A camera that is accepted is used: its rays
// must be finite where they exist, and what a run records of it must be the same camera.
#include "server/calibration/calibration_file.hpp"

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "server/record/rows/run_rows.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  const auto file = fuzz::InputFolder::of_process().file("camera.json", fuzz::text_of(data, size));
  const auto camera = server::read_calibrated_camera(file);
  if (!camera) return 0;
  const PinholeCamera& pinhole = camera->pinhole();
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      const auto ray = camera->ray({x * pinhole.width_px, y * pinhole.height_px});
      if (ray && !ray->allFinite()) std::abort();
    }
  }
  const auto again = server::camera_model_from(server::json_from(*camera));
  if (!again || again->pinhole().fx_px != pinhole.fx_px ||
      again->distortion().k != camera->distortion().k) {
    std::abort();
  }
  return 0;
}
