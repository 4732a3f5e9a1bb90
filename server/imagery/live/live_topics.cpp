// Live images of LCM channels and ROS 1 topics.
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "flight/logs/images/logged_picture.hpp"
#include "middleware/lcm/channel_listener.hpp"
#include "middleware/ros1/topic_listener.hpp"
#include "server/imagery/grey_picture.hpp"
#include "server/imagery/live/live_images.hpp"

namespace overfly::server {
namespace {

using flight::logs::PictureMessage;
using flight::logs::RosEncoding;

/// A message as it arrived: it is decoded only if it is still the newest when it is asked for.
class NewestMessage {
 public:
  void put(PictureMessage kind, std::span<const std::uint8_t> bytes) {
    const std::lock_guard lock(mutex_);
    kind_ = kind;
    bytes_.assign(bytes.begin(), bytes.end());
    fresh_ = true;
    changed_.notify_all();
  }
  [[nodiscard]] Result<std::optional<Image>> take(std::chrono::milliseconds patience) {
    std::vector<std::uint8_t> bytes;
    PictureMessage kind = PictureMessage::kRosImage;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait_for(lock, patience, [&] { return fresh_; })) return std::optional<Image>();
      fresh_ = false;
      bytes.swap(bytes_);
      kind = kind_;
    }
    const auto picture = flight::logs::picture_in(kind, bytes, RosEncoding::kRos1);
    if (!picture) return Error{ErrorCode::kUnreadable, "a message is no image, or is damaged"};
    Result<Image> image = grey_picture(*picture);
    if (!image) return image.error();
    return std::optional(std::move(*image));
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  PictureMessage kind_ = PictureMessage::kRosImage;
  std::vector<std::uint8_t> bytes_;
  bool fresh_ = false;
};

class ChannelImages final : public LiveImages {
 public:
  Status open(const LiveAddress& address, const std::atomic<bool>* cancel) {
    auto listener = lcm::listen_to_channel(
        address.url,
        address.topic,
        [this](std::span<const std::uint8_t> bytes) { newest_.put(PictureMessage::kLcm, bytes); },
        cancel);
    if (!listener) return listener.error().in(address.name);
    listener_ = std::move(*listener);
    return {};
  }
  [[nodiscard]] Result<std::optional<Image>> next(std::chrono::milliseconds patience) override {
    return newest_.take(patience);
  }

 private:
  NewestMessage newest_;
  std::shared_ptr<void> listener_;  ///< ends before newest_
};

class TopicImages final : public LiveImages {
 public:
  Status open(const LiveAddress& address, const std::atomic<bool>* cancel) {
    ros1::TopicListenerOptions options;
    options.master_uri = address.url;
    options.topics = {address.topic};
    options.images = true;
    auto listener = ros1::TopicListener::open(
        options, [this](const ros1::ListenedMessage& message) { take(message); }, cancel);
    if (!listener) return listener.error().in(address.name);
    listener_ = std::move(*listener);
    return {};
  }
  [[nodiscard]] Result<std::optional<Image>> next(std::chrono::milliseconds patience) override {
    return newest_.take(patience);
  }

 private:
  void take(const ros1::ListenedMessage& message) {
    if (message.type == "sensor_msgs/Image") newest_.put(PictureMessage::kRosImage, message.bytes);
    if (message.type == "sensor_msgs/CompressedImage") {
      newest_.put(PictureMessage::kRosCompressedImage, message.bytes);
    }
  }

  NewestMessage newest_;
  std::unique_ptr<ros1::TopicListener> listener_;  ///< ends before newest_
};

template <typename Images>
Result<std::unique_ptr<LiveImages>> opened(const LiveAddress& address,
                                           const std::atomic<bool>* cancel) {
  auto images = std::make_unique<Images>();
  if (Status status = images->open(address, cancel); !status) return status.error();
  return std::unique_ptr<LiveImages>(std::move(images));
}

}  // namespace

Result<std::unique_ptr<LiveImages>> open_live_images(const LiveAddress& address,
                                                     const std::atomic<bool>* cancel) {
  switch (address.kind) {
    case LiveKind::kLcm:
      return opened<ChannelImages>(address, cancel);
    case LiveKind::kRos1:
      return opened<TopicImages>(address, cancel);
    case LiveKind::kRtsp:
    case LiveKind::kHttp:
    case LiveKind::kV4l2:
      break;
  }
  return open_video_stream(address, cancel);
}

}  // namespace overfly::server
