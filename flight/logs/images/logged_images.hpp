// The images of a log: those of one topic of a ROS bag or MCAP file, or of one channel of an LCM
// event log.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/images/logged_picture.hpp"

namespace overfly::flight::logs {

/// Finds the images in one pass over the file and then reads them one by one, in any order. Read
/// are sensor_msgs/Image and CompressedImage of ROS 1 and ROS 2, Overfly's own LCM images and those
/// of libbot (bot_core.image_t). Memory: 40 bytes an image, one chunk and one image.
class LoggedImages {
 public:
  /// @param topic  or channel; empty: the only one that has images
  /// @param cancel  stops reading; may be null
  /// Errors: as detect_format; kInvalidArgument for a topic without images, or none where several
  /// have them, listing those; kUnreadable without any image or with more than kMaxImages; kIo;
  /// kCancelled.
  [[nodiscard]] static Result<std::unique_ptr<LoggedImages>> open(const std::filesystem::path& file,
                                                                  const std::string& topic,
                                                                  const std::atomic<bool>* cancel);
  ~LoggedImages();
  LoggedImages(const LoggedImages&) = delete;
  LoggedImages& operator=(const LoggedImages&) = delete;

  [[nodiscard]] const std::string& topic() const;
  /// Stamps of the images, increasing: of ROS the header's, of Overfly's LCM type `t_ns`, of
  /// libbot's `utime`. Images with the stamp of another one are left out.
  [[nodiscard]] const std::vector<std::int64_t>& stamps_ns() const;
  /// What was left out of the file.
  [[nodiscard]] const std::vector<std::string>& warnings() const;

  /// The image; valid until the next call.
  /// Errors: kIo; kUnreadable naming the file and the image.
  [[nodiscard]] Result<LoggedPicture> read(std::size_t i);

  static constexpr std::size_t kMaxImages = 2'000'000;
  /// Larger messages are not read.
  static constexpr std::uint64_t kMaxImageBytes = std::uint64_t{128} << 20U;

 private:
  struct Impl;
  explicit LoggedImages(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::flight::logs
