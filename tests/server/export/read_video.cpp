#include "tests/server/export/read_video.hpp"

#include <gtest/gtest.h>
#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>
#include <webm/callback.h>
#include <webm/file_reader.h>
#include <webm/webm_parser.h>

#include <cmath>
#include <cstdio>
#include <memory>

namespace overfly::server::testing {
namespace {

class Collector final : public webm::Callback {
 public:
  explicit Collector(WebmContent& content) : content_(content) {}

  webm::Status OnElementBegin(const webm::ElementMetadata& metadata,
                              webm::Action* action) override {
    if (metadata.id == webm::Id::kSegment) {
      segment_begin_ = metadata.position + metadata.header_size;
    } else if (segment_begin_ > 0) {
      content_.elements.emplace_back(static_cast<std::uint32_t>(metadata.id),
                                     metadata.position - segment_begin_);
    }
    *action = webm::Action::kRead;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnUnknownElement(const webm::ElementMetadata& metadata,
                                webm::Reader* reader,
                                std::uint64_t* bytes_remaining) override {
    ADD_FAILURE() << "unknown element " << static_cast<std::uint32_t>(metadata.id);
    return Callback::OnUnknownElement(metadata, reader, bytes_remaining);
  }
  webm::Status OnEbml(const webm::ElementMetadata& /*metadata*/, const webm::Ebml& ebml) override {
    content_.doc_type = ebml.doc_type.value();
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnSeek(const webm::ElementMetadata& /*metadata*/, const webm::Seek& seek) override {
    content_.seeks.emplace_back(static_cast<std::uint32_t>(seek.id.value()), seek.position.value());
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnInfo(const webm::ElementMetadata& /*metadata*/, const webm::Info& info) override {
    EXPECT_EQ(info.timecode_scale.value(), 1'000'000U);
    content_.duration_ms = info.duration.value();
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnTrackEntry(const webm::ElementMetadata& /*metadata*/,
                            const webm::TrackEntry& track) override {
    content_.codec = track.codec_id.value();
    content_.width_px = track.video.value().pixel_width.value();
    content_.height_px = track.video.value().pixel_height.value();
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnCuePoint(const webm::ElementMetadata& /*metadata*/,
                          const webm::CuePoint& cue) override {
    content_.cues.push_back(
        {cue.time.value(), cue.cue_track_positions.at(0).value().cluster_position.value()});
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnClusterBegin(const webm::ElementMetadata& metadata,
                              const webm::Cluster& cluster,
                              webm::Action* action) override {
    content_.clusters.push_back({metadata.position - segment_begin_, cluster.timecode.value()});
    *action = webm::Action::kRead;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnSimpleBlockBegin(const webm::ElementMetadata& /*metadata*/,
                                  const webm::SimpleBlock& block,
                                  webm::Action* action) override {
    EXPECT_EQ(block.track_number, 1U);
    VideoPacket packet;
    packet.t_ms = static_cast<std::int64_t>(content_.clusters.back().t_ms) + block.timecode;
    packet.key = block.is_key_frame;
    content_.packets.push_back(packet);
    *action = webm::Action::kRead;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnFrame(const webm::FrameMetadata& /*metadata*/,
                       webm::Reader* reader,
                       std::uint64_t* bytes_remaining) override {
    std::vector<std::uint8_t>& bytes = content_.packets.back().bytes;
    while (*bytes_remaining > 0) {
      const std::size_t before = bytes.size();
      bytes.resize(before + *bytes_remaining);
      std::uint64_t read = 0;
      const webm::Status status = reader->Read(*bytes_remaining, bytes.data() + before, &read);
      bytes.resize(before + read);
      *bytes_remaining -= read;
      if (!status.completed_ok()) return status;
    }
    return webm::Status(webm::Status::kOkCompleted);
  }

 private:
  WebmContent& content_;
  std::uint64_t segment_begin_ = 0;
};

std::vector<std::uint8_t> plane_of(const vpx_image_t& image, int plane, int width, int height) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* row = image.planes[plane] + std::ptrdiff_t{y} * image.stride[plane];
    bytes.insert(bytes.end(), row, row + width);
  }
  return bytes;
}

}  // namespace

WebmContent read_webm(const std::filesystem::path& file) {
  WebmContent content;
  std::FILE* stream = std::fopen(file.c_str(), "rb");
  if (stream == nullptr) {
    ADD_FAILURE() << file << " cannot be opened";
    return content;
  }
  webm::FileReader reader(stream);
  Collector collector(content);
  webm::WebmParser parser;
  const webm::Status status = parser.Feed(&collector, &reader);
  EXPECT_TRUE(status.completed_ok()) << "libwebm: status " << status.code;
  return content;
}

std::vector<PlanarImage> decode_vp9(const std::vector<VideoPacket>& packets) {
  std::vector<PlanarImage> images;
  vpx_codec_ctx_t codec{};
  if (vpx_codec_dec_init(&codec, vpx_codec_vp9_dx(), nullptr, 0) != VPX_CODEC_OK) {
    ADD_FAILURE() << "libvpx has no VP9 decoder";
    return images;
  }
  for (const VideoPacket& packet : packets) {
    EXPECT_EQ(
        vpx_codec_decode(
            &codec, packet.bytes.data(), static_cast<unsigned>(packet.bytes.size()), nullptr, 0),
        VPX_CODEC_OK)
        << "image at " << packet.t_ms << " ms";
    vpx_codec_iter_t position = nullptr;
    while (const vpx_image_t* image = vpx_codec_get_frame(&codec, &position)) {
      EXPECT_EQ(image->fmt, VPX_IMG_FMT_I420);
      EXPECT_EQ(image->cs, VPX_CS_BT_709);
      EXPECT_EQ(image->range, VPX_CR_STUDIO_RANGE);
      PlanarImage planar;
      planar.width_px = static_cast<int>(image->d_w);
      planar.height_px = static_cast<int>(image->d_h);
      planar.y = plane_of(*image, VPX_PLANE_Y, planar.width_px, planar.height_px);
      planar.u = plane_of(*image, VPX_PLANE_U, planar.width_px / 2, planar.height_px / 2);
      planar.v = plane_of(*image, VPX_PLANE_V, planar.width_px / 2, planar.height_px / 2);
      images.push_back(std::move(planar));
    }
  }
  vpx_codec_destroy(&codec);
  return images;
}

double psnr_db(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  if (a.size() != b.size() || a.empty()) return -1.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = double(a[i]) - double(b[i]);
    sum += difference * difference;
  }
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / std::max(sum, 1e-9));
}

}  // namespace overfly::server::testing
