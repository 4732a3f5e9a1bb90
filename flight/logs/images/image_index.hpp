// Where the images of a log are. Private to images.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flight/logs/images/logged_picture.hpp"
#include "flight/logs/lcm/lcm_events.hpp"
#include "flight/logs/ros/message_sink.hpp"

namespace overfly::flight::logs {

struct IndexedImage {
  static constexpr std::uint32_t kNoChunk = 0xFFFFFFFF;
  std::int64_t stamp_ns = 0;
  std::uint64_t offset = 0;  ///< in the decompressed chunk, or in the file
  std::uint64_t bytes = 0;
  std::uint32_t chunk = kNoChunk;
};

/// The images of a topic.
struct ImageTopic {
  std::string name;  ///< printable
  PictureMessage kind = PictureMessage::kRosImage;
  RosEncoding encoding = RosEncoding::kRos1;
  std::vector<IndexedImage> images;
  std::uint64_t without_stamp = 0;  ///< messages that are too short
  std::uint64_t repeated = 0;       ///< images with the stamp of another one
};

/// Collects the images of a recording while it is read.
class ImageIndex final : public RosMessageSink {
 public:
  /// @param topic  the only one to collect; empty: all
  /// @param limit  images in total; more are counted only
  ImageIndex(std::string topic, std::size_t limit) : topic_(std::move(topic)), limit_(limit) {}

  [[nodiscard]] std::optional<Topic> add(const std::string& name,
                                         std::string_view type,
                                         RosEncoding encoding) override;
  void take(Topic topic,
            std::span<const std::uint8_t> data,
            std::uint64_t recorded_ns,
            const MessagePlace& place) override;
  /// Orders the images by their stamps.
  void report() override;
  void take(const LcmEvent& event);

  [[nodiscard]] std::vector<ImageTopic>& topics() { return topics_; }
  [[nodiscard]] const std::vector<ChunkPlace>& chunks() const { return chunks_; }
  [[nodiscard]] bool full() const { return count_ > limit_; }

 private:
  std::string topic_;
  std::size_t limit_;
  std::size_t count_ = 0;
  std::vector<ImageTopic> topics_;
  std::vector<ChunkPlace> chunks_;
};

}  // namespace overfly::flight::logs
