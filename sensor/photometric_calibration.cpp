#include "sensor/photometric_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace overfly::sensor {
namespace fs = std::filesystem;

std::array<double, 256> inverse_response(const SensorModel& model) {
  std::array<double, 256> irradiance{};
  const int shared = 1 << (model.bits - 8);  // numbers with the same high 8 bits
  const double largest = (1 << model.bits) - 1;
  for (int value = 0; value < 256; ++value) {
    const double middle = value * shared + 0.5 * (shared - 1);
    irradiance[value] = model.response.inverse(middle / largest);
  }
  const double scale = 255.0 / irradiance[255];
  for (double& value : irradiance) value *= scale;
  return irradiance;
}

Image16 vignette_map(const SensorModel& model, const CameraModel& camera) {
  const PinholeCamera& pinhole = camera.pinhole();
  Image16 map(pinhole.width_px, pinhole.height_px, 1, 65535);
  if (!model.vignette) return map;
  const double scale = 2.0 / std::hypot(pinhole.width_px, pinhole.height_px);
  std::vector<double> transmission;
  transmission.reserve(map.data.size());
  for (int y = 0; y < pinhole.height_px; ++y) {
    for (int x = 0; x < pinhole.width_px; ++x) {
      const double r = scale * std::hypot(x - pinhole.cx_px, y - pinhole.cy_px);
      transmission.push_back(model.vignette->transmission(r));
    }
  }
  const double largest = *std::max_element(transmission.begin(), transmission.end());
  for (std::size_t i = 0; i < transmission.size(); ++i) {
    map.data[i] = static_cast<std::uint16_t>(std::lround(65535.0 * transmission[i] / largest));
  }
  return map;
}

Status write_pcalib(const fs::path& file, const SensorModel& model) {
  fs::path part = file;
  part += ".part";
  std::ofstream out(part);
  std::array<char, 32> text{};
  for (const double value : inverse_response(model)) {
    const int length = std::snprintf(text.data(), text.size(), "%.9g ", value);
    out.write(text.data(), length);
  }
  out << '\n';
  out.close();
  std::error_code failed;
  if (out.good()) fs::rename(part, file, failed);
  if (out.good() && !failed) return {};
  fs::remove(part, failed);
  return Error{ErrorCode::kIo, file.string() + ": cannot be written"};
}

}  // namespace overfly::sensor
