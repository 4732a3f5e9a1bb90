#include "flight/logs/images/image_index.hpp"

#include <algorithm>

#include "core/text/printable_text.hpp"
#include "flight/logs/ros/ros_messages.hpp"

namespace overfly::flight::logs {
namespace {

/// A recording has some hundred topics.
constexpr std::size_t kMaxImageTopics = 4096;

}  // namespace

std::optional<RosMessageSink::Topic> ImageIndex::add(const std::string& name,
                                                     std::string_view type,
                                                     RosEncoding encoding) {
  const RosType known = ros_type_named(type);
  const bool image = known == RosType::kImage;
  if (encoding == RosEncoding::kOther || (!image && known != RosType::kCompressedImage)) {
    return std::nullopt;
  }
  const std::string shown =
      printable_text({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()});
  const auto kind = image ? PictureMessage::kRosImage : PictureMessage::kRosCompressedImage;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const ImageTopic& other = topics_[i];
    if (other.name == shown && other.kind == kind && other.encoding == encoding) return i;
  }
  if (topics_.size() >= kMaxImageTopics) return std::nullopt;
  topics_.push_back({shown, kind, encoding, {}, 0, 0});
  return topics_.size() - 1;
}

void ImageIndex::take(Topic topic,
                      std::span<const std::uint8_t> data,
                      std::uint64_t /*recorded_ns*/,
                      const MessagePlace& place) {
  ImageTopic& of = topics_[topic];
  if (!topic_.empty() && of.name != topic_) return;
  const std::optional<std::int64_t> stamp_ns = picture_stamp_ns(of.kind, data, of.encoding);
  if (!stamp_ns) {
    ++of.without_stamp;
    return;
  }
  if (++count_ > limit_) return;
  IndexedImage image{*stamp_ns, place.offset, place.bytes, IndexedImage::kNoChunk};
  if (place.chunk) {
    if (chunks_.empty() || chunks_.back().file_offset != place.chunk->file_offset) {
      chunks_.push_back(*place.chunk);
    }
    image.chunk = static_cast<std::uint32_t>(chunks_.size() - 1);
  }
  of.images.push_back(image);
}

void ImageIndex::take(const LcmEvent& event) {
  if (!is_lcm_image(event.data)) return;
  const std::string name = printable_text(event.channel);
  std::size_t topic = 0;
  while (topic < topics_.size() && topics_[topic].name != name) ++topic;
  if (topic == topics_.size()) {
    if (topics_.size() >= kMaxImageTopics) return;
    topics_.push_back({name, PictureMessage::kLcm, RosEncoding::kOther, {}, 0, 0});
  }
  take(topic, event.data, 0, {std::nullopt, event.data_at, event.data_bytes});
}

void ImageIndex::report() {
  for (ImageTopic& topic : topics_) {
    std::vector<IndexedImage>& images = topic.images;
    std::stable_sort(images.begin(), images.end(), [](const auto& a, const auto& b) {
      return a.stamp_ns < b.stamp_ns;
    });
    const auto end = std::unique(images.begin(), images.end(), [](const auto& a, const auto& b) {
      return a.stamp_ns == b.stamp_ns;
    });
    topic.repeated = static_cast<std::uint64_t>(images.end() - end);
    images.erase(end, images.end());
  }
}

}  // namespace overfly::flight::logs
