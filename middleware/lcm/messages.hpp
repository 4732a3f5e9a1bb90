// Converts between Overfly's types and LCM messages.
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <overfly_lcm/calibration_t.hpp>
#include <overfly_lcm/image_t.hpp>
#include <overfly_lcm/truth_t.hpp>
#include <span>
#include <string>

#include "core/camera/camera.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "middleware/lcm/lengths.hpp"

namespace overfly::lcm {

/// Converts a grey or RGB image; session, sequence and request fields stay 0.
/// @param crc32  of the image, if already known
[[nodiscard]] overfly_lcm::image_t image_message(const Image& image,
                                                 std::int64_t frame,
                                                 std::int64_t t_ns,
                                                 std::int64_t exposure_ns,
                                                 std::optional<std::uint32_t> crc32);

/// Time, session and lockstep stay 0.
/// @param parameters  requested for the estimator
[[nodiscard]] overfly_lcm::calibration_t calibration_message(
    const std::string& camera,
    const PinholeCamera& pinhole,
    const Distortion& distortion,
    const std::map<std::string, std::string>& parameters);

/// @param stamp_ns  of the image
[[nodiscard]] overfly_lcm::truth_t truth_message(std::int64_t frame,
                                                 std::int64_t t_ns,
                                                 std::int64_t stamp_ns,
                                                 const Pose& T_world_camera);

/// Decodes a message; empty if the bytes are not valid. Messages of the types in lengths.hpp cannot
/// allocate more memory than their size implies.
template <typename Message>
[[nodiscard]] std::optional<Message> decode_message(std::span<const std::uint8_t> bytes) {
  Message message;
  if constexpr (requires { lengths_fit(bytes, message); }) {
    if (!lengths_fit(bytes, message)) return std::nullopt;
  }
  // The code of lcm-gen throws on a string without terminator.
  try {
    if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return message;
}

}  // namespace overfly::lcm
