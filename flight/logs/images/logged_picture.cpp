// After the definitions of sensor_msgs/Image and CompressedImage, middleware/lcm/types/image_t.lcm
// and libbot's bot_core image_t.lcm.
#include "flight/logs/images/logged_picture.hpp"

#include <string_view>

#include "flight/logs/lcm/lcm_messages.hpp"
#include "flight/logs/ros/ros_messages.hpp"

namespace overfly::flight::logs {
namespace {

constexpr int kMaxSidePx = 16384;

struct PixelFormatName {
  std::uint32_t fourcc;  ///< as Video4Linux writes them
  std::string_view encoding;
};

constexpr PixelFormatName kPixelFormats[] = {
    {1497715271, "mono8"},       // GREY
    {859981650, "rgb8"},         // RGB3
    {861030210, "bgr8"},         // BGR3
    {876758866, "rgba8"},        // RGB4
    {877807426, "bgra8"},        // BGR4
    {1498831189, "uyvy"},        // UYVY
    {1448695129, "yuyv"},        // YUYV
    {1196444237, "compressed"},  // MJPG
};

/// The offsets of an LCM type's fields: five numbers of 4 bytes from `width_at` on, and the data.
struct LcmImageLayout {
  std::size_t time_at;
  std::int64_t ns_per_unit;
  std::size_t width_at;
};

std::optional<LcmImageLayout> lcm_layout(std::span<const std::uint8_t> message) {
  const auto fingerprint = big_endian_at<std::uint64_t>(message, 0);
  if (fingerprint == static_cast<std::uint64_t>(LcmType::kImage)) return LcmImageLayout{16, 1, 65};
  if (fingerprint == kBotCoreImage) return LcmImageLayout{8, 1000, 16};
  return std::nullopt;
}

/// Empty unless the rows fit into the data.
std::optional<LoggedPicture> checked(LoggedPicture picture,
                                     std::uint32_t width,
                                     std::uint32_t height) {
  if (picture.encoding == "compressed") return picture;
  if (width == 0 || height == 0 || width > kMaxSidePx || height > kMaxSidePx) return std::nullopt;
  if (picture.row_bytes < width || picture.row_bytes > picture.data.size() ||
      picture.data.size() / picture.row_bytes < height) {
    return std::nullopt;
  }
  picture.width_px = static_cast<int>(width);
  picture.height_px = static_cast<int>(height);
  return picture;
}

std::optional<LoggedPicture> lcm_picture(std::span<const std::uint8_t> message) {
  const std::optional<LcmImageLayout> layout = lcm_layout(message);
  if (!layout) return std::nullopt;
  const std::size_t data_at = layout->width_at + 5 * sizeof(std::uint32_t);
  if (message.size() < data_at) return std::nullopt;
  const auto field = [&](std::size_t i) {
    return big_endian_at<std::uint32_t>(message, layout->width_at + i * sizeof(std::uint32_t));
  };
  if (field(4) > message.size() - data_at) return std::nullopt;
  LoggedPicture picture;
  picture.encoding = "pixel format " + std::to_string(field(3));
  for (const PixelFormatName& known : kPixelFormats) {
    if (known.fourcc == field(3)) picture.encoding = known.encoding;
  }
  picture.row_bytes = field(2);
  picture.data = message.subspan(data_at, field(4));
  return checked(std::move(picture), field(0), field(1));
}

}  // namespace

std::optional<LoggedPicture> picture_in(PictureMessage kind,
                                        std::span<const std::uint8_t> message,
                                        RosEncoding encoding) {
  if (kind == PictureMessage::kLcm) return lcm_picture(message);
  std::optional<RosCursor> fields = ros_cursor_of(message, encoding);
  if (!fields) return std::nullopt;
  (void)take_header(*fields);
  LoggedPicture picture;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  if (kind == PictureMessage::kRosCompressedImage) {
    (void)fields->text();  // format: the bytes say it more reliably
    picture.encoding = "compressed";
  } else {
    height = fields->number<std::uint32_t>();
    width = fields->number<std::uint32_t>();
    picture.encoding = fields->text();
    picture.big_endian = fields->number<std::uint8_t>() != 0;
    picture.row_bytes = fields->number<std::uint32_t>();
  }
  picture.data = fields->octets();
  if (!fields->ok()) return std::nullopt;
  return checked(std::move(picture), width, height);
}

std::optional<std::int64_t> picture_stamp_ns(PictureMessage kind,
                                             std::span<const std::uint8_t> message,
                                             RosEncoding encoding) {
  constexpr std::int64_t kLatestNs = std::int64_t{1} << 62U;
  if (kind == PictureMessage::kLcm) {
    const std::optional<LcmImageLayout> layout = lcm_layout(message);
    if (!layout || message.size() < layout->width_at) return std::nullopt;
    const auto stamp = big_endian_at<std::int64_t>(message, layout->time_at);
    if (stamp < 0 || stamp > kLatestNs / layout->ns_per_unit) return std::nullopt;
    return stamp * layout->ns_per_unit;
  }
  std::optional<RosCursor> fields = ros_cursor_of(message, encoding);
  if (!fields) return std::nullopt;
  const std::int64_t stamp_ns = take_header(*fields).stamp_ns;
  if (!fields->ok() || stamp_ns < 0 || stamp_ns > kLatestNs) return std::nullopt;
  return stamp_ns;
}

bool is_lcm_image(std::span<const std::uint8_t> message) { return lcm_layout(message).has_value(); }

}  // namespace overfly::flight::logs
