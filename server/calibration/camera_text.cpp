#include "server/calibration/camera_text.hpp"

#include <array>
#include <initializer_list>
#include <span>
#include <utility>

#include "server/files/number_text.hpp"

namespace overfly::server {
namespace {

/// Lines "KEY: VALUE".
std::string yaml_lines(std::initializer_list<std::pair<const char*, double>> fields) {
  std::string text;
  for (const auto& [key, value] : fields)
    text += std::string(key) + ": " + yaml_number(value) + "\n";
  return text;
}

std::string coefficients(const Distortion& lens, std::size_t count) {
  return yaml_list(std::span(lens.k).first(count));
}

Error lens_unsupported(CameraFormat format, const Distortion& lens, const std::string& must) {
  return {ErrorCode::kUnsupported,
          std::string("distortion ") + to_string(lens.model) + ": must " + must + " for " +
              to_string(format)};
}

bool is_radtan_or_none(const Distortion& lens) {
  return lens.model == DistortionModel::kNone || lens.model == DistortionModel::kRadtan;
}

/// Formats with k1 k2 p1 p2.
Status require_four(CameraFormat format, const Distortion& lens) {
  if (lens.k[4] == 0.0 || lens.model != DistortionModel::kRadtan) return {};
  return Error{ErrorCode::kUnsupported,
               "distortion k3 = " + number_text(lens.k[4]) + ": must be 0 for " +
                   to_string(format) + ", which holds only k1 k2 p1 p2"};
}

/// ORB-SLAM2 uses 30 for a frame rate of 0.
Result<std::string> orb_slam2_text(const CameraModel& camera) {
  const Distortion& lens = camera.distortion();
  if (!is_radtan_or_none(lens)) {
    return lens_unsupported(CameraFormat::kOrbSlam2, lens, "be none or radtan");
  }
  const PinholeCamera& c = camera.pinhole();
  return "%YAML:1.0\n" +
         yaml_lines({{"Camera.fx", c.fx_px},
                     {"Camera.fy", c.fy_px},
                     {"Camera.cx", c.cx_px},
                     {"Camera.cy", c.cy_px},
                     {"Camera.k1", lens.k[0]},
                     {"Camera.k2", lens.k[1]},
                     {"Camera.p1", lens.k[2]},
                     {"Camera.p2", lens.k[3]},
                     {"Camera.k3", lens.k[4]},
                     {"Camera.bf", 0.0},
                     {"Camera.fps", 0.0}}) +
         "Camera.width: " + std::to_string(c.width_px) +
         "\nCamera.height: " + std::to_string(c.height_px) + "\nCamera.RGB: 1\n";
}

/// Name and coefficients of a lens, as in the first line of camera.txt.
Result<std::string> dso_lens(const Distortion& lens, const std::string& intrinsics) {
  const std::string four = number_list({lens.k[0], lens.k[1], lens.k[2], lens.k[3]}, " ");
  switch (lens.model) {
    case DistortionModel::kNone:
      return "Pinhole " + intrinsics + " 0";
    case DistortionModel::kFov:
      return "FOV " + intrinsics + " " + number_text(lens.k[0]);
    case DistortionModel::kEquidistant:
      return "EquiDistant " + intrinsics + " " + four;
    case DistortionModel::kRadtan:
      break;
  }
  if (Status status = require_four(CameraFormat::kDso, lens); !status) return status.error();
  return "RadTan " + intrinsics + " " + four;
}

/// Intrinsics relative to the image's size, which every reader of the format accepts. DSO converts
/// them to pixels as cx = cx_relative * width - 0.5; half a pixel is therefore added here.
Result<std::string> dso_text(const CameraModel& camera) {
  const PinholeCamera& c = camera.pinhole();
  const std::string intrinsics = number_list({c.fx_px / c.width_px,
                                              c.fy_px / c.height_px,
                                              (c.cx_px + 0.5) / c.width_px,
                                              (c.cy_px + 0.5) / c.height_px},
                                             " ");
  const Result<std::string> first = dso_lens(camera.distortion(), intrinsics);
  if (!first) return first.error();
  const std::string size = std::to_string(c.width_px) + " " + std::to_string(c.height_px) + "\n";
  const bool pinhole = camera.distortion().none();
  return *first + "\n" + size + (pinhole ? "none" : "crop") + "\n" + size;
}

Result<std::string> svo_text(const CameraModel& camera) {
  const Distortion& lens = camera.distortion();
  if (!is_radtan_or_none(lens)) {
    return lens_unsupported(CameraFormat::kSvo, lens, "be none or radtan");
  }
  if (Status status = require_four(CameraFormat::kSvo, lens); !status) return status.error();
  const PinholeCamera& c = camera.pinhole();
  return "cam_model: Pinhole\ncam_width: " + std::to_string(c.width_px) +
         "\ncam_height: " + std::to_string(c.height_px) + "\n" +
         yaml_lines({{"cam_fx", c.fx_px},
                     {"cam_fy", c.fy_px},
                     {"cam_cx", c.cx_px},
                     {"cam_cy", c.cy_px},
                     {"cam_d0", lens.k[0]},
                     {"cam_d1", lens.k[1]},
                     {"cam_d2", lens.k[2]},
                     {"cam_d3", lens.k[3]}});
}

std::string ros_matrix(const char* name, int rows, int cols, const std::string& data) {
  return std::string(name) + ":\n  rows: " + std::to_string(rows) +
         "\n  cols: " + std::to_string(cols) + "\n  data: " + data + "\n";
}

Result<std::string> ros_text(const CameraModel& camera, const std::string& name) {
  const Distortion& lens = camera.distortion();
  if (lens.model == DistortionModel::kFov) {
    return lens_unsupported(CameraFormat::kRos, lens, "be none, radtan or equidistant");
  }
  const PinholeCamera& c = camera.pinhole();
  const bool fisheye = lens.model == DistortionModel::kEquidistant;
  const std::size_t count = fisheye ? 4 : 5;
  constexpr double kTurn[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double K[] = {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1};
  const double P[] = {c.fx_px, 0, c.cx_px, 0, 0, c.fy_px, c.cy_px, 0, 0, 0, 1, 0};
  return "image_width: " + std::to_string(c.width_px) +
         "\nimage_height: " + std::to_string(c.height_px) + "\ncamera_name: " + name + "\n" +
         ros_matrix("camera_matrix", 3, 3, yaml_list(K)) +
         "distortion_model: " + (fisheye ? "equidistant" : "plumb_bob") + "\n" +
         ros_matrix(
             "distortion_coefficients", 1, static_cast<int>(count), coefficients(lens, count)) +
         ros_matrix("rectification_matrix", 3, 3, yaml_list(kTurn)) +
         ros_matrix("projection_matrix", 3, 4, yaml_list(P));
}

Result<std::string> kalibr_text(const CameraModel& camera) {
  const Distortion& lens = camera.distortion();
  const PinholeCamera& c = camera.pinhole();
  if (Status status = require_four(CameraFormat::kKalibr, lens); !status) return status.error();
  const char* model = "radtan";
  std::size_t count = 4;
  if (lens.model == DistortionModel::kNone) {
    model = "none";
    count = 0;
  } else if (lens.model == DistortionModel::kEquidistant) {
    model = "equi";
  } else if (lens.model == DistortionModel::kFov) {
    model = "fov";
    count = 1;
  }
  return "cam0:\n  camera_model: pinhole\n  intrinsics: " +
         yaml_list(std::array{c.fx_px, c.fy_px, c.cx_px, c.cy_px}) +
         "\n  distortion_model: " + model + "\n  distortion_coeffs: " + coefficients(lens, count) +
         "\n  resolution: [" + std::to_string(c.width_px) + ", " + std::to_string(c.height_px) +
         "]\n  rostopic: /camera/image_raw\n  cam_overlaps: []\n";
}

}  // namespace

const char* to_string(CameraFormat format) {
  switch (format) {
    case CameraFormat::kOrbSlam2:
      return "orb-slam2";
    case CameraFormat::kDso:
      return "dso";
    case CameraFormat::kSvo:
      return "svo";
    case CameraFormat::kRos:
      return "ros";
    case CameraFormat::kKalibr:
      break;
  }
  return "kalibr";
}

std::optional<CameraFormat> camera_format_from(const std::string& text) {
  for (const CameraFormat format : kCameraFormats) {
    if (text == to_string(format)) return format;
  }
  return std::nullopt;
}

Result<std::string> camera_text(CameraFormat format,
                                const CameraModel& camera,
                                const std::string& name) {
  switch (format) {
    case CameraFormat::kOrbSlam2:
      return orb_slam2_text(camera);
    case CameraFormat::kDso:
      return dso_text(camera);
    case CameraFormat::kSvo:
      return svo_text(camera);
    case CameraFormat::kRos:
      return ros_text(camera, name);
    case CameraFormat::kKalibr:
      break;
  }
  return kalibr_text(camera);
}

}  // namespace overfly::server
