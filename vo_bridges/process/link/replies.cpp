// Decodes an estimator's messages and checks every field.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "vo_bridges/estimator_text.hpp"
#include "vo_bridges/process/link/messages.hpp"

namespace overfly::process {

namespace {

Error bad_reply(const std::string& what) { return {ErrorCode::kInternal, what}; }

Error wrong_length(const char* message, std::size_t bytes, const std::string& limit) {
  return bad_reply(std::string(message) + " has " + std::to_string(bytes) + " bytes: must be " +
                   limit);
}

Status check_frame(const char* message, std::int64_t index, const VoFrame& frame) {
  if (index == frame.index) return {};
  return bad_reply(std::string(message) + " is for frame " + std::to_string(index) + ": frame " +
                   std::to_string(frame.index) + " is expected");
}

/// Reads the pose unchecked: PoseIntake checks it, as well as map points.
void read_pose(ByteReader* reader, EstimateSample* sample) {
  for (int i = 0; i < 3; ++i) sample->T_vo_camera.translation[i] = reader->f64();
  for (int i = 0; i < 4; ++i) sample->T_vo_camera.rotation.coeffs()[i] = reader->f64();  // x y z w
  const double depth = reader->f64();
  if (sample->state != TrackingState::kTracking) {
    sample->T_vo_camera = {};
    return;
  }
  if (depth != 0.0) sample->scene_depth = depth;
}

/// Parses "covariance VALUE ...": PoseIntake checks the values and their number.
Status read_covariance(std::string_view text, VoEstimate* estimate) {
  estimate->covariance.clear();
  while (!text.empty()) {
    const std::string_view digits = text.substr(0, text.find(' '));
    double number = 0.0;
    const auto [end, failure] = std::from_chars(digits.begin(), digits.end(), number);
    const bool too_large = failure == std::errc::result_out_of_range;
    if ((failure != std::errc{} && !too_large) || end != digits.end()) {
      return bad_reply("'covariance' has '" + printable(digits, 80) +
                       "': must be numbers, separated by one space each");
    }
    estimate->covariance.push_back(too_large ? std::numeric_limits<double>::infinity() : number);
    text.remove_prefix(std::min(text.size(), digits.size() + 1));
  }
  return {};
}

/// Parses "counter NAME VALUE", "timing_ms NAME VALUE" and "covariance VALUE ...".
Status read_figures(std::string_view text, FigureIntake* figures, VoEstimate* estimate) {
  for (const auto& [key, value] : lines_of(text)) {
    if (key == "covariance") {
      if (Status status = read_covariance(value, estimate); !status) return status;
    }
    const bool counter = key == "counter";
    if (!counter && key != "timing_ms") continue;
    const std::size_t space = value.find(' ');
    const std::string_view name = value.substr(0, space);
    const std::string_view digits =
        space == std::string_view::npos ? std::string_view{} : value.substr(space + 1);
    double number = 0.0;
    const auto [end, failure] = std::from_chars(digits.begin(), digits.end(), number);
    const bool too_large = failure == std::errc::result_out_of_range;
    if (!is_figure_name(name) || (failure != std::errc{} && !too_large) || end != digits.end()) {
      return bad_reply(std::string("'") + printable(key) + " " + printable(value, 80) +
                       "': must be a name and a number");
    }
    if (too_large) number = std::numeric_limits<double>::infinity();
    if (counter) {
      if (figures->takes_counter(name, number)) estimate->counters[std::string(name)] = number;
    } else {
      if (figures->takes_timing(name, number)) estimate->timing_ms[std::string(name)] = number;
    }
  }
  return {};
}

}  // namespace

Result<EstimatorHello> hello_from(std::string_view payload) {
  EstimatorHello hello;
  bool version_said = false;
  for (const auto& [key, value] : lines_of(payload)) {
    if (key == "protocol") {
      version_said = true;
      if (value != std::to_string(kProtocolVersion)) {
        return bad_reply("the estimator uses protocol version '" + printable(value, 40) +
                         "': must be " + std::to_string(kProtocolVersion));
      }
    }
    if (key == "name") hello.name = printable(value, kNameLimitBytes);
    if (key == "version") hello.version = printable(value, kNameLimitBytes);
    if (key == "sensors") hello.takes_sensors = value == "true";
    if (key == "shared_memory") hello.takes_shared_memory = value == "true";
  }
  if (!version_said) return bad_reply("HELLO lacks 'protocol': " + shown(payload));
  if (hello.name.empty()) return bad_reply("HELLO lacks 'name': " + shown(payload));
  return hello;
}

Result<VoEstimate> answer_from(std::string_view payload,
                               const VoFrame& frame,
                               FigureIntake* figures) {
  ByteReader reader(payload);
  const std::int64_t index = reader.i64();
  const std::uint32_t state = reader.u32();
  const std::uint32_t map_id = reader.u32();
  if (payload.size() < 88) return wrong_length("ANSWER", payload.size(), "88 or more");
  if (Status status = check_frame("ANSWER", index, frame); !status) return status.error();
  if (state > 2) return bad_reply("state = " + std::to_string(state) + ": must be 0, 1 or 2");
  if (map_id > static_cast<std::uint32_t>(std::numeric_limits<int>::max())) {
    return bad_reply("map_id = " + std::to_string(map_id) + ": is too large");
  }
  VoEstimate estimate;
  estimate.sample.frame = frame.index;
  estimate.sample.t_ns = frame.t_ns;
  estimate.sample.state = static_cast<TrackingState>(state);
  estimate.sample.map_id = static_cast<int>(map_id);
  read_pose(&reader, &estimate.sample);
  const std::uint32_t crc32 = reader.u32();
  const std::uint32_t flags = reader.u32();
  if ((flags & 1U) != 0) estimate.image_crc32 = crc32;
  if (Status status = read_figures(reader.rest(), figures, &estimate); !status) {
    return status.error();
  }
  return estimate;
}

Result<Image> debug_image_from(std::string_view payload, const VoFrame& frame) {
  ByteReader reader(payload);
  const std::int64_t index = reader.i64();
  const std::uint32_t width = reader.u32();
  const std::uint32_t height = reader.u32();
  const std::uint32_t channels = reader.u32();
  reader.u32();
  if (!reader.complete()) return wrong_length("DEBUG_IMAGE", payload.size(), "24 or more");
  if (Status status = check_frame("DEBUG_IMAGE", index, frame); !status) return status.error();
  const PinholeCamera& camera = frame.intrinsics;
  if (width < 1 || height < 1 || width > static_cast<std::uint32_t>(camera.width_px) ||
      height > static_cast<std::uint32_t>(camera.height_px) || (channels != 1 && channels != 3)) {
    return bad_reply("DEBUG_IMAGE is " + std::to_string(width) + " x " + std::to_string(height) +
                     " px of " + std::to_string(channels) + " channels: must be at most " +
                     std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) +
                     " px of 1 or 3 channels");
  }
  const std::string_view pixels = reader.rest();
  const std::size_t bytes = std::size_t{width} * height * channels;
  if (pixels.size() != bytes) {
    return wrong_length("DEBUG_IMAGE", payload.size(), std::to_string(24 + bytes));
  }
  Image image(static_cast<int>(width), static_cast<int>(height), 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>(pixels[channels == 3 ? i : i / 3]);
  }
  return image;
}

Result<std::vector<Eigen::Vector3f>> map_points_from(std::string_view payload,
                                                     const VoFrame& frame) {
  ByteReader reader(payload);
  const std::int64_t index = reader.i64();
  const std::uint32_t count = reader.u32();
  reader.u32();
  if (!reader.complete()) return wrong_length("MAP_POINTS", payload.size(), "16 or more");
  if (Status status = check_frame("MAP_POINTS", index, frame); !status) return status.error();
  if (reader.rest().size() != std::size_t{count} * 12) {
    return wrong_length("MAP_POINTS", payload.size(), std::to_string(16 + std::size_t{count} * 12));
  }
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& point : points) {
    for (int i = 0; i < 3; ++i) point[i] = reader.f32();
  }
  return points;
}

Result<std::map<std::string, std::string>> parameters_from(std::string_view payload) {
  std::map<std::string, std::string> parameters;
  for (const auto& [name, value] : lines_of(payload)) {
    if (!is_figure_name(name)) {
      return bad_reply("PARAMETERS names '" + printable(name, 80) +
                       "': must be 1 to 128 visible ASCII characters");
    }
    parameters[std::string(name)] = printable(value);
  }
  return parameters;
}

Result<std::string> log_line_from(std::string_view payload) {
  ByteReader reader(payload);
  const std::uint32_t level = reader.u32();
  if (!reader.complete() || level > 3) {
    return bad_reply("LOG must have a level in [0, 3]: " + shown(payload));
  }
  const char* const mark = level == 3 ? "error: " : level == 2 ? "warning: " : "";
  return mark + printable(reader.rest());
}

}  // namespace overfly::process
