#include "flight/logs/images/logged_images.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/cancel.hpp"
#include "core/outside/forward_reader.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/images/image_index.hpp"
#include "flight/logs/mcap/mcap_reader.hpp"
#include "flight/logs/record_pass.hpp"
#include "flight/logs/rosbag/rosbag_reader.hpp"

namespace overfly::flight::logs {
namespace {

namespace fs = std::filesystem;

/// Takes only the warnings of a reader.
class WarningSink final : public LogSink {
 public:
  explicit WarningSink(const std::atomic<bool>* cancel) : cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId /*id*/, const StreamDescription& /*description*/) override {
    return false;
  }
  void message(StreamId /*id*/, const std::optional<LogTime>& /*time*/) override {}
  void local_origin(StreamId /*id*/, const LocalOrigin& /*origin*/) override {}
  void event(LogEvent /*event*/) override {}
  void warning(const std::string& text) override { warnings_.push_back(text); }
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }
  [[nodiscard]] std::vector<std::string>& warnings() { return warnings_; }

 private:
  void take_position(StreamId /*id*/,
                     const LogTime& /*time*/,
                     const Eigen::Vector3d& /*value*/) override {}
  void take_attitude(StreamId /*id*/,
                     const LogTime& /*time*/,
                     const Eigen::Quaterniond& /*R_ned_body*/) override {}
  void take_invalid(StreamId /*id*/) override {}
  [[nodiscard]] PositionKind position_kind(StreamId /*id*/) const override {
    return PositionKind::kNone;
  }

  const std::atomic<bool>* cancel_;
  std::vector<std::string> warnings_;
};

Status index_images(LogFormat format, ForwardReader& file, LogSink& sink, ImageIndex& index) {
  switch (format) {
    case LogFormat::kMcap:
      return read_mcap_messages(file, sink, index);
    case LogFormat::kRosbag:
      return read_rosbag_messages(file, sink, index);
    case LogFormat::kLcm: {
      Status status =
          read_lcm_events(file, sink, [&](const LcmEvent& event) { index.take(event); });
      index.report();
      return status;
    }
    default:
      return Error{ErrorCode::kInvalidArgument,
                   std::string("a log of format ") + to_string(format) +
                       " holds no images: must be rosbag, mcap or lcm"};
  }
}

/// Names of topics for an error: a file may have thousands, of any length.
std::string names_of(const std::vector<ImageTopic>& topics) {
  constexpr std::size_t kShownTopics = 20;
  constexpr std::size_t kShownBytes = 100;
  std::string names;
  for (std::size_t i = 0; i < std::min(kShownTopics, topics.size()); ++i) {
    names += (i == 0 ? "" : ", ") + topics[i].name.substr(0, kShownBytes);
  }
  if (topics.size() > kShownTopics) {
    names += " and " + std::to_string(topics.size() - kShownTopics) + " more";
  }
  return names;
}

/// The topic of this name, or the only one with images.
Result<std::size_t> chosen_topic(const std::vector<ImageTopic>& topics, const std::string& name) {
  std::optional<std::size_t> found;
  std::size_t with_images = 0;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const bool wanted = name.empty() || topics[i].name == name;
    if (!wanted || topics[i].images.empty()) continue;
    ++with_images;
    if (!found) found = i;
  }
  if (with_images > 1 && name.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "several topics have images, one must be named: " + names_of(topics)};
  }
  if (found) return *found;
  if (topics.empty()) return Error{ErrorCode::kUnreadable, "contains no images"};
  return Error{ErrorCode::kInvalidArgument,
               "topic = " + name +
                   ": has no images that can be read (topics of images: " + names_of(topics) + ")"};
}

}  // namespace

struct LoggedImages::Impl {
  fs::path name;
  ForwardReader file;
  ImageTopic topic;
  std::vector<ChunkPlace> chunks;
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::string> warnings;
  ChunkReader chunk_reader;
  std::uint32_t chunk = IndexedImage::kNoChunk;  ///< the one in chunk_bytes
  std::span<const std::uint8_t> chunk_bytes;
  std::vector<std::uint8_t> message;  ///< one that is not in a chunk

  [[nodiscard]] Result<std::span<const std::uint8_t>> bytes_of(const IndexedImage& image);
  [[nodiscard]] Error unreadable(std::size_t i, const std::string& what) const {
    return {ErrorCode::kUnreadable,
            name.string() + ": image " + std::to_string(i) + " of " + topic.name + ": " + what};
  }
};

/// Fewer bytes than the image has if the file has become shorter, or its chunk is damaged.
Result<std::span<const std::uint8_t>> LoggedImages::Impl::bytes_of(const IndexedImage& image) {
  if (image.chunk == IndexedImage::kNoChunk) {
    message.clear();
    file.only({{image.offset, image.offset + image.bytes}});
    const Result<std::uint64_t> passed =
        pass_over(file, image.bytes, [this](std::span<const std::uint8_t> piece) {
          message.insert(message.end(), piece.begin(), piece.end());
        });
    if (!passed) return passed.error();
    return std::span<const std::uint8_t>(message);
  }
  if (chunk != image.chunk) {
    const ChunkPlace& place = chunks[image.chunk];
    chunk = IndexedImage::kNoChunk;
    file.only({{place.file_offset, place.file_offset + place.stored_bytes}});
    const Result<ChunkReader::Chunk> read =
        chunk_reader.read(file, place.stored_bytes, place.compression, place.declared_bytes, {});
    if (!read) return read.error();
    chunk = image.chunk;
    chunk_bytes = read->bytes;
  }
  if (image.offset > chunk_bytes.size()) return std::span<const std::uint8_t>();
  return chunk_bytes.subspan(
      image.offset, std::min<std::uint64_t>(image.bytes, chunk_bytes.size() - image.offset));
}

LoggedImages::LoggedImages(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LoggedImages::~LoggedImages() = default;

Result<std::unique_ptr<LoggedImages>> LoggedImages::open(const fs::path& file,
                                                         const std::string& topic,
                                                         const std::atomic<bool>* cancel) {
  const Result<LogFormat> format = detect_format(file);
  if (!format) return format.error();
  Result<ForwardReader> reader = ForwardReader::open(file);
  if (!reader) return reader.error();
  WarningSink sink(cancel);
  ImageIndex index(topic, kMaxImages);
  if (Status status = index_images(*format, *reader, sink, index); !status) {
    return status.error().in(file.string());
  }
  if (index.full()) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": has more than " + std::to_string(kMaxImages) + " images"};
  }
  const Result<std::size_t> chosen = chosen_topic(index.topics(), topic);
  if (!chosen) return chosen.error().in(file.string());
  auto impl = std::make_unique<Impl>(Impl{file,
                                          std::move(*reader),
                                          std::move(index.topics()[*chosen]),
                                          index.chunks(),
                                          {},
                                          std::move(sink.warnings()),
                                          {},
                                          IndexedImage::kNoChunk,
                                          {},
                                          {}});
  const ImageTopic& images = impl->topic;
  for (const IndexedImage& image : images.images) impl->stamps_ns.push_back(image.stamp_ns);
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) impl->warnings.push_back(std::to_string(count) + " " + text);
  };
  warn(images.without_stamp, "images are shorter than their header and were left out");
  warn(images.repeated, "images have the time stamp of another one and were left out");
  return std::unique_ptr<LoggedImages>(new LoggedImages(std::move(impl)));
}

const std::string& LoggedImages::topic() const { return impl_->topic.name; }
const std::vector<std::int64_t>& LoggedImages::stamps_ns() const { return impl_->stamps_ns; }
const std::vector<std::string>& LoggedImages::warnings() const { return impl_->warnings; }

Result<LoggedPicture> LoggedImages::read(std::size_t i) {
  const IndexedImage& image = impl_->topic.images.at(i);
  if (image.bytes > kMaxImageBytes) {
    return impl_->unreadable(i, std::to_string(image.bytes) + " bytes: must be at most 128 MiB");
  }
  const Result<std::span<const std::uint8_t>> bytes = impl_->bytes_of(image);
  if (!bytes) return bytes.error();
  std::optional<LoggedPicture> picture =
      picture_in(impl_->topic.kind, *bytes, impl_->topic.encoding);
  if (!picture) return impl_->unreadable(i, "ends early, or its lengths contradict each other");
  return std::move(*picture);
}

}  // namespace overfly::flight::logs
