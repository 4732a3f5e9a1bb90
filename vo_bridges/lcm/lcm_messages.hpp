// Converts between Overfly's types and LCM messages.
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <overfly_lcm/calibration_t.hpp>
#include <overfly_lcm/debug_t.hpp>
#include <overfly_lcm/image_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <span>
#include <string>

#include "core/camera_model.hpp"
#include "core/result.hpp"
#include "vo_bridges/lcm/lcm_lengths.hpp"
#include "vo_bridges/parameter.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Converts a grey or RGB image; session, sequence and request fields stay 0.
/// @param crc32  of the image, if already known
[[nodiscard]] overfly_lcm::image_t image_message(const Image& image,
                                                 std::int64_t frame,
                                                 std::int64_t t_ns,
                                                 std::int64_t exposure_ns,
                                                 std::optional<std::uint32_t> crc32);

/// Time, session and lockstep stay 0.
[[nodiscard]] overfly_lcm::calibration_t calibration_message(const std::string& camera,
                                                             const PinholeCamera& pinhole,
                                                             const Distortion& distortion,
                                                             const VoParameters& parameters);

/// Whether a name of a parameter, counter or timing is valid: 1 to 128 printable ASCII characters
/// without spaces, as in the process protocol.
[[nodiscard]] bool is_figure_name(const std::string& name);

/// Converts all but the debug image; the names of counters and timings are not checked. Errors:
/// kUnreadable naming the field, its value and limit.
[[nodiscard]] Result<VoEstimate> estimate_from(const overfly_lcm::pose_t& message);

/// Content of a PREFIX_DEBUG message.
struct DebugView {
  std::optional<Image> image;
  std::vector<Eigen::Vector3f> map_points_vo;
};
/// Errors: kUnreadable, as for estimate_from.
[[nodiscard]] Result<DebugView> debug_view_from(const overfly_lcm::debug_t& message,
                                                int largest_width_px,
                                                int largest_height_px);

/// Decodes a message; empty if the bytes are not valid. Messages from an estimator cannot allocate
/// more memory than their size implies.
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

}  // namespace overfly
