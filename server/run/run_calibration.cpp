#include "server/run/run_calibration.hpp"

#include <algorithm>
#include <system_error>

#include "sensor/photometric_calibration.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/fault_spec.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr int kFrameDigits = 6;  ///< same as the images in frames/
constexpr double kNsPerMs = 1e6;

bool got_lost(const FrameRow& row) {
  const std::string dropped = to_string(FaultKind::kDroppedFrames);
  return std::find(row.faults.begin(), row.faults.end(), dropped) != row.faults.end();
}

}  // namespace

fs::path calibration_folder(const fs::path& run_folder, const std::string& camera) {
  return run_folder / "photometric" / camera;
}

Status write_calibration(const fs::path& run_folder, const CameraSpec& camera) {
  if (!camera.sensor.enabled) return {};
  const fs::path folder = calibration_folder(run_folder, camera.name);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  if (Status status = sensor::write_pcalib(folder / "pcalib.txt", camera.sensor); !status) {
    return status;
  }
  return write_png_file(folder / "vignette.png", sensor::vignette_map(camera.sensor, camera.model));
}

Status write_times(const fs::path& run_folder,
                   const CameraSpec& camera,
                   const std::vector<FrameRow>& frames) {
  if (!camera.sensor.enabled) return {};
  std::string text;
  for (const FrameRow& row : frames) {
    if (got_lost(row)) continue;
    // Gain brightens like exposure, and the format has no field for it.
    text += padded(row.frame, kFrameDigits) + " " + seconds_text(row.t_ns + row.stamp_offset_ns) +
            " " + number_text(1e-6 * static_cast<double>(row.exposure_ns) * row.gain) + "\n";
  }
  return write_whole(calibration_folder(run_folder, camera.name) / "times.txt", text);
}

}  // namespace overfly::server
