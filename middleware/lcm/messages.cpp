#include "middleware/lcm/messages.hpp"

#include <algorithm>

#include "core/measure/crc32.hpp"

namespace overfly::lcm {

overfly_lcm::image_t image_message(const Image& image,
                                   std::int64_t frame,
                                   std::int64_t t_ns,
                                   std::int64_t exposure_ns,
                                   std::optional<std::uint32_t> crc32) {
  overfly_lcm::image_t message{};
  message.utime = t_ns / 1000;
  message.t_ns = t_ns;
  message.frame = frame;
  message.exposure_ns = exposure_ns;
  message.crc32 = crc32 ? *crc32 : crc32_of(image);
  message.width = image.width_px;
  message.height = image.height_px;
  message.row_stride = image.width_px * image.channels;
  message.pixelformat = overfly_lcm::image_t::PIXEL_FORMAT_GREY;
  if (image.channels == 3) message.pixelformat = overfly_lcm::image_t::PIXEL_FORMAT_RGB;
  message.size = static_cast<std::int32_t>(image.data.size());
  message.data = image.data;
  return message;
}

overfly_lcm::calibration_t calibration_message(
    const std::string& camera,
    const PinholeCamera& pinhole,
    const Distortion& distortion,
    const std::map<std::string, std::string>& parameters) {
  overfly_lcm::calibration_t message{};
  message.camera = camera;
  message.width = pinhole.width_px;
  message.height = pinhole.height_px;
  message.fx = pinhole.fx_px;
  message.fy = pinhole.fy_px;
  message.cx = pinhole.cx_px;
  message.cy = pinhole.cy_px;
  message.distortion_model = to_string(distortion.model);
  std::copy(distortion.k.begin(), distortion.k.end(), message.distortion);
  for (const auto& [name, value] : parameters) {
    overfly_lcm::named_text_t& parameter = message.parameters.emplace_back();
    parameter.name = name;
    parameter.value = value;
  }
  message.nparameters = static_cast<std::int32_t>(message.parameters.size());
  return message;
}

overfly_lcm::truth_t truth_message(std::int64_t frame,
                                   std::int64_t t_ns,
                                   std::int64_t stamp_ns,
                                   const Pose& T_world_camera) {
  overfly_lcm::truth_t message{};
  message.utime = t_ns / 1000;
  message.t_ns = t_ns;
  message.stamp_ns = stamp_ns;
  message.frame = frame;
  std::copy_n(T_world_camera.translation.data(), 3, message.position);
  std::copy_n(T_world_camera.rotation.coeffs().data(), 4, message.orientation);
  return message;
}

}  // namespace overfly::lcm
