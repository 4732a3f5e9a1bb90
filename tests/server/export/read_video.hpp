// A WebM file read back by libwebm's parser, its images by libvpx's decoder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/export/video/vp9_encoder.hpp"

namespace overfly::server::testing {

struct WebmContent {
  std::string doc_type;
  std::string codec;
  std::uint64_t width_px = 0;
  std::uint64_t height_px = 0;
  double duration_ms = 0.0;
  struct Cue {
    std::uint64_t t_ms = 0;
    std::uint64_t cluster_position = 0;  ///< from the segment's content
  };
  std::vector<Cue> cues;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> seeks;  ///< id, position likewise
  struct Cluster {
    std::uint64_t position = 0;  ///< likewise
    std::uint64_t t_ms = 0;
  };
  std::vector<Cluster> clusters;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> elements;  ///< of the segment: id, position
  std::vector<VideoPacket> packets;
};

/// Fails the test where the parser finds a fault or an element that it does not know.
[[nodiscard]] WebmContent read_webm(const std::filesystem::path& file);

/// The images of packets; fails the test where libvpx finds a fault.
[[nodiscard]] std::vector<PlanarImage> decode_vp9(const std::vector<VideoPacket>& packets);

/// Peak signal-to-noise ratio of bytes [dB].
[[nodiscard]] double psnr_db(const std::vector<std::uint8_t>& a,
                             const std::vector<std::uint8_t>& b);

}  // namespace overfly::server::testing
