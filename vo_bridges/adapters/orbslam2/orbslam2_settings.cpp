#include "vo_bridges/adapters/orbslam2/orbslam2_settings.hpp"

#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <stdexcept>

namespace overfly_adapters {
namespace {

std::string settings_of(const Session& session) {
  const AdapterCamera& camera = session.camera;
  if (camera.distortion != "none" && camera.distortion != "radtan") {
    throw std::runtime_error("distortion " + camera.distortion +
                             ": must be none or radtan for ORB-SLAM2");
  }
  std::vector<double> d = camera.distortion_coefficients;
  d.resize(5, 0.0);
  std::string text = "%YAML:1.0\n";
  const auto line = [&text](const char* key, double value) {
    text += std::string(key) + ": " + text_of_number(value) + "\n";
  };
  line("Camera.fx", camera.fx_px);
  line("Camera.fy", camera.fy_px);
  line("Camera.cx", camera.cx_px);
  line("Camera.cy", camera.cy_px);
  line("Camera.k1", d[0]);
  line("Camera.k2", d[1]);
  line("Camera.p1", d[2]);
  line("Camera.p2", d[3]);
  line("Camera.k3", d[4]);
  line("Camera.bf", 0.0);
  line("Camera.fps", camera.rate_hz);  // 0: it uses 30
  line("Camera.RGB", 1.0);
  for (const char* key : {"ORBextractor.nFeatures",
                          "ORBextractor.scaleFactor",
                          "ORBextractor.nLevels",
                          "ORBextractor.iniThFAST",
                          "ORBextractor.minThFAST"}) {
    text += std::string(key) + ": " + session.parameters.at(key) + "\n";
  }
  return text;
}

}  // namespace

SettingsFile::SettingsFile(const Session& session) {
  const std::string text = settings_of(session);
  const char* folder = std::getenv("TMPDIR");
  path_ = std::string(folder != nullptr ? folder : "/tmp") + "/overfly-orbslam2-XXXXXX.yaml";
  const int file = ::mkstemps(&path_[0], 5);
  if (file < 0) throw std::runtime_error("cannot write " + path_);
  const ssize_t written = ::write(file, text.data(), text.size());
  ::close(file);
  if (written != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error("cannot write " + path_);
  }
}

SettingsFile::~SettingsFile() { ::unlink(path_.c_str()); }

}  // namespace overfly_adapters
