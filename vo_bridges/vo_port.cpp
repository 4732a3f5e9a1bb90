#include "vo_bridges/vo_port.hpp"

#include <array>
#include <cstddef>

namespace overfly {

namespace {

/// Table k: effect of a byte on the remainder k bytes later (Sarwate 1988, DOI 10.1145/63030.63037,
/// eight bytes at a time).
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables crc_tables() {
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? 0xEDB88320U : 0U);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8U) ^ tables[0][before & 255U];
    }
  }
  return tables;
}

bool same_lens(const Distortion& a, const Distortion& b) {
  return a.model == b.model && a.k == b.k;
}

}  // namespace

std::uint32_t crc32_of(const Image& image) {
  static constexpr CrcTables kTables = crc_tables();
  const std::vector<std::uint8_t>& bytes = image.data;
  std::uint32_t rest = 0xFFFFFFFFU;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      next ^= kTables[7 - k][(bytes[i + k] ^ (rest >> (8U * k))) & 255U];
      next ^= kTables[3 - k][bytes[i + 4 + k]];
    }
    rest = next;
  }
  for (; i < bytes.size(); ++i) {
    rest = (rest >> 8U) ^ kTables[0][(rest ^ bytes[i]) & 255U];
  }
  return ~rest;
}

Status validate_vo_frame(const VoFrame& frame, const VoFrame* previous) {
  const std::string where = "frame " + std::to_string(frame.index);
  const auto bad = [&](const std::string& what) {
    return Error{ErrorCode::kInvalidArgument, where + ": " + what};
  };
  if (!frame.image || frame.image->empty()) return bad("the image is empty");
  if (frame.image->channels != 1) {
    return bad("the image has " + std::to_string(frame.image->channels) +
               " channels: must be 1 (grey)");
  }
  if (Status status = frame.intrinsics.validate(); !status) return status.error().in(where);
  if (frame.image->width_px != frame.intrinsics.width_px ||
      frame.image->height_px != frame.intrinsics.height_px) {
    return bad("the image is " + std::to_string(frame.image->width_px) + " x " +
               std::to_string(frame.image->height_px) + " px, its intrinsics are for " +
               std::to_string(frame.intrinsics.width_px) + " x " +
               std::to_string(frame.intrinsics.height_px) + " px");
  }
  if (previous == nullptr) {
    // Only for the first frame: the check covers the whole lens.
    Status status = CameraModel(frame.intrinsics, frame.distortion).validate();
    return status ? status : status.error().in(where);
  }
  if (frame.index <= previous->index || frame.t_ns <= previous->t_ns) {
    return bad("not after frame " + std::to_string(previous->index));
  }
  if (frame.intrinsics.width_px != previous->intrinsics.width_px ||
      frame.intrinsics.height_px != previous->intrinsics.height_px) {
    return bad("the image size changed in flight");
  }
  const PinholeCamera& now = frame.intrinsics;
  const PinholeCamera& first = previous->intrinsics;
  if (now.fx_px != first.fx_px || now.fy_px != first.fy_px || now.cx_px != first.cx_px ||
      now.cy_px != first.cy_px) {
    return bad("the intrinsics changed in flight");
  }
  if (!same_lens(frame.distortion, previous->distortion)) {
    return bad("the lens distortion changed in flight");
  }
  return {};
}

}  // namespace overfly
