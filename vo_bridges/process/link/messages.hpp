// Encodes and decodes the messages of the process protocol (docs/VO_PROTOCOL.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"
#include "vo_bridges/process/link/figure_intake.hpp"
#include "vo_bridges/process/link/wire.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::process {

/// What an estimator reports about itself.
struct EstimatorHello {
  std::string name;
  std::string version;
  bool takes_shared_memory = false;
  bool takes_sensors = false;
};

/// Shared memory for frames; without slots frames are sent through the socket.
struct FrameSlots {
  std::size_t count = 0;
  std::size_t bytes_each = 0;
};

/// How a frame is sent.
struct FrameSending {
  std::uint32_t crc32 = 0;
  bool debug_wanted = false;
  bool in_shared_memory = false;
  std::uint32_t slot = 0;
};

[[nodiscard]] std::string server_hello(bool lockstep, const VoParameters& wanted);
[[nodiscard]] std::string calibration_message(const VoFrame& frame,
                                              double rate_hz,
                                              const FrameSlots& slots);
/// The number of inertial samples for which FRAME has room next to the image.
[[nodiscard]] std::size_t most_imu_samples(const VoFrame& frame, bool in_shared_memory);
/// A FRAME message without the pixels. They follow unless they are in shared memory.
[[nodiscard]] std::string frame_message(const VoFrame& frame, const FrameSending& sending);

/// A SENSORS message with the samples of a frame, except those of the IMU, which FRAME contains.
/// Empty without samples.
[[nodiscard]] std::string sensors_message(const VoFrame& frame);

/// Errors of all decoding functions: kInternal naming the field, its value and the problem.
[[nodiscard]] Result<EstimatorHello> hello_from(std::string_view payload);
/// The answer to `frame`. The pose is not checked; `figures` selects the counters and timings.
[[nodiscard]] Result<VoEstimate> answer_from(std::string_view payload,
                                             const VoFrame& frame,
                                             FigureIntake* figures);
/// RGB, converted if necessary.
[[nodiscard]] Result<Image> debug_image_from(std::string_view payload, const VoFrame& frame);
[[nodiscard]] Result<std::vector<Eigen::Vector3f>> map_points_from(std::string_view payload,
                                                                   const VoFrame& frame);
[[nodiscard]] Result<std::map<std::string, std::string>> parameters_from(std::string_view payload);
/// One line, with a prefix for warnings and errors.
[[nodiscard]] Result<std::string> log_line_from(std::string_view payload);

}  // namespace overfly::process
