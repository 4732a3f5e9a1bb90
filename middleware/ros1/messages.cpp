#include "middleware/ros1/messages.hpp"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>

namespace overfly::ros1 {
namespace {

namespace encodings = sensor_msgs::image_encodings;

template <typename Translation, typename Rotation>
std::optional<Pose> pose_of(const Translation& t, const Rotation& q) {
  Pose pose;
  pose.translation = {t.x, t.y, t.z};
  pose.rotation = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  const double length = pose.rotation.norm();
  constexpr double kPercent = 0.01;  // a larger deviation is not a rounding error
  if (!pose.translation.allFinite() || !(std::abs(length - 1.0) < kPercent)) return std::nullopt;
  pose.rotation.normalize();
  return pose;
}

/// Offsets of the colours within a pixel.
struct PixelLayout {
  std::uint32_t bytes;
  std::uint32_t red, green, blue;
};

std::optional<PixelLayout> layout_of(const std::string& encoding) {
  if (encoding == encodings::MONO8 || encoding == encodings::TYPE_8UC1) {
    return PixelLayout{1, 0, 0, 0};
  }
  if (encoding == encodings::RGB8) return PixelLayout{3, 0, 1, 2};
  if (encoding == encodings::BGR8 || encoding == encodings::TYPE_8UC3) {
    return PixelLayout{3, 2, 1, 0};
  }
  if (encoding == encodings::RGBA8) return PixelLayout{4, 0, 1, 2};
  if (encoding == encodings::BGRA8) return PixelLayout{4, 2, 1, 0};
  return std::nullopt;
}

}  // namespace

ros::Time time_from_ns(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

ImageMessage message_from(const Image& image) {
  ImageMessage message;
  message.width = static_cast<std::uint32_t>(image.width_px);
  message.height = static_cast<std::uint32_t>(image.height_px);
  message.encoding = image.channels == 1 ? encodings::MONO8 : encodings::RGB8;
  message.is_bigendian = 0;
  message.step = static_cast<std::uint32_t>(image.width_px * image.channels);
  message.data.assign(image.data.begin(), image.data.end());
  return message;
}

CameraInfoMessage message_from(const PinholeCamera& c, const Distortion& distortion) {
  CameraInfoMessage info;
  info.width = static_cast<std::uint32_t>(c.width_px);
  info.height = static_cast<std::uint32_t>(c.height_px);
  info.K = {c.fx_px, 0.0, c.cx_px, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {c.fx_px, 0.0, c.cx_px, 0.0, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 0.0, 1.0, 0.0};
  int count = coefficient_count(distortion.model);
  switch (distortion.model) {
    case DistortionModel::kNone:
    case DistortionModel::kRadtan:
      info.distortion_model = "plumb_bob";
      count = coefficient_count(DistortionModel::kRadtan);
      break;
    case DistortionModel::kEquidistant:
      info.distortion_model = "equidistant";
      break;
    case DistortionModel::kFov:
      info.distortion_model = "fov";
      break;
  }
  info.D.assign(distortion.k.begin(), distortion.k.begin() + count);
  return info;
}

PoseMessage pose_message_from(const Pose& pose) {
  PoseMessage message;
  message.position.x = pose.translation.x();
  message.position.y = pose.translation.y();
  message.position.z = pose.translation.z();
  message.orientation.x = pose.rotation.x();
  message.orientation.y = pose.rotation.y();
  message.orientation.z = pose.rotation.z();
  message.orientation.w = pose.rotation.w();
  return message;
}

TransformMessage transform_message_from(const Pose& pose) {
  const PoseMessage same = pose_message_from(pose);
  TransformMessage message;
  message.translation.x = same.position.x;
  message.translation.y = same.position.y;
  message.translation.z = same.position.z;
  message.rotation = same.orientation;
  return message;
}

std::optional<Pose> pose_from(const PoseMessage& message) {
  return pose_of(message.position, message.orientation);
}

std::optional<Pose> pose_from(const TransformMessage& message) {
  return pose_of(message.translation, message.rotation);
}

Result<Image> rgb_image_from(const ImageMessage& message, int most_width_px, int most_height_px) {
  const auto bad = [](const std::string& what) { return Error{ErrorCode::kUnreadable, what}; };
  const std::optional<PixelLayout> layout = layout_of(message.encoding);
  if (!layout) {
    return bad("encoding '" + message.encoding +
               "': must be mono8, rgb8, bgr8, rgba8, bgra8, 8UC1 or 8UC3");
  }
  const std::uint64_t row_bytes = std::uint64_t{message.width} * layout->bytes;
  if (message.width == 0 || message.height == 0 || message.step < row_bytes ||
      message.data.size() < std::uint64_t{message.step} * message.height) {
    return bad(std::to_string(message.width) + " x " + std::to_string(message.height) +
               " px with rows of " + std::to_string(message.step) + " bytes do not fit " +
               std::to_string(message.data.size()) + " bytes");
  }
  const auto factor_for = [](std::uint32_t size, int most) {
    const auto limit = static_cast<std::uint32_t>(most);
    return (size + limit - 1) / limit;
  };
  const std::uint32_t factor = std::max(factor_for(message.width, most_width_px),
                                        factor_for(message.height, most_height_px));
  Image image(static_cast<int>(std::max(message.width / factor, 1U)),
              static_cast<int>(std::max(message.height / factor, 1U)),
              3);
  std::uint8_t* out = image.data.data();
  for (int y = 0; y < image.height_px; ++y) {
    const std::uint8_t* row =
        message.data.data() + std::size_t{message.step} * factor * static_cast<std::size_t>(y);
    for (int x = 0; x < image.width_px; ++x, out += 3) {
      const std::uint8_t* pixel = row + std::size_t{layout->bytes} * factor * x;
      out[0] = pixel[layout->red];
      out[1] = pixel[layout->green];
      out[2] = pixel[layout->blue];
    }
  }
  return image;
}

}  // namespace overfly::ros1
