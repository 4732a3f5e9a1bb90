#include "server/frame_cache/frame_codec.hpp"

// The switch for Huffman codes at any speed is declared for static linking only.
#define ZSTD_STATIC_LINKING_ONLY
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>
#include <type_traits>

#include "core/measure/crc32.hpp"

namespace overfly::server {
namespace {

/// Changes with every change of the format.
constexpr std::uint32_t kPictureMagic = 0x3143464F;  // "OFC1"
/// Hardly any search for repetitions, which textures do not have.
constexpr int kHuffmanOnly = -1000;
/// For bytes that are nearly always the same.
constexpr int kFastSearch = -8;

/// The metadata of a picture, as stored: fixed size, no padding.
struct Header {
  std::uint32_t magic = kPictureMagic;
  std::uint32_t crc32 = 0;  ///< of all bytes that follow
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  std::int32_t channels = 0;
  std::uint32_t linear = 0;  ///< radiances, else 8-bit samples
  std::int64_t t_ns = 0;
  std::array<double, 7> T_world_camera{};  ///< x y z, qx qy qz qw
  double texels_per_pixel_min = 0.0;
  double texels_per_pixel_median = 0.0;
  double void_fraction = 0.0;
  double axis_depth_m = 0.0;
  std::uint64_t has_axis_depth = 0;
  /// Bytes of the parts: 8-bit samples, or the radiances' third, fourth and lower bytes.
  std::array<std::uint64_t, 3> part_bytes{};
};
static_assert(std::has_unique_object_representations_v<std::array<std::uint64_t, 3>> &&
              sizeof(Header) == 24 + 8 + 56 + 32 + 8 + 24);
constexpr std::size_t kCheckedFrom = 2 * sizeof(std::uint32_t);

Header header_of(const renderer::CameraFrame& frame) {
  Header header;
  header.linear = frame.radiance.empty() ? 0 : 1;
  header.width_px = header.linear != 0 ? frame.radiance.width_px : frame.image.width_px;
  header.height_px = header.linear != 0 ? frame.radiance.height_px : frame.image.height_px;
  header.channels = header.linear != 0 ? frame.radiance.channels : frame.image.channels;
  header.t_ns = frame.t_ns;
  const Pose& pose = frame.T_world_camera;
  std::copy_n(pose.translation.data(), 3, header.T_world_camera.begin());
  std::copy_n(pose.rotation.coeffs().data(), 4, header.T_world_camera.begin() + 3);
  header.texels_per_pixel_min = frame.texels_per_pixel_min;
  header.texels_per_pixel_median = frame.texels_per_pixel_median;
  header.void_fraction = frame.void_fraction;
  header.axis_depth_m = frame.axis_depth_m.value_or(0.0);
  header.has_axis_depth = frame.axis_depth_m ? 1 : 0;
  return header;
}

renderer::CameraFrame frame_of(const Header& header, const renderer::CameraRequest& request) {
  renderer::CameraFrame frame;
  frame.t_ns = header.t_ns;
  std::copy_n(header.T_world_camera.begin(), 3, frame.T_world_camera.translation.data());
  std::copy_n(header.T_world_camera.begin() + 3, 4, frame.T_world_camera.rotation.coeffs().data());
  frame.camera = request.camera;
  frame.texels_per_pixel_min = header.texels_per_pixel_min;
  frame.texels_per_pixel_median = header.texels_per_pixel_median;
  frame.void_fraction = header.void_fraction;
  if (header.has_axis_depth != 0) frame.axis_depth_m = header.axis_depth_m;
  return frame;
}

bool is_picture_of(const Header& header, const renderer::CameraRequest& request) {
  const PinholeCamera& pinhole = request.camera.pinhole();
  return header.magic == kPictureMagic && header.width_px == pinhole.width_px &&
         header.height_px == pinhole.height_px &&
         header.channels == renderer::channel_count(request.format) &&
         (header.linear != 0) == renderer::is_linear(request.format);
}

Error damaged() { return {ErrorCode::kUnreadable, "is damaged"}; }

/// Small numbers for small differences of either sign.
std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1U) ^ (0U - (difference >> 31U));
}
std::uint32_t from_zigzag(std::uint32_t value) { return (value >> 1U) ^ (0U - (value & 1U)); }

/// Of each sample to the one above it; the first row as it is.
void take_differences(std::span<const std::uint8_t> samples,
                      std::size_t row,
                      std::uint8_t* __restrict out) {
  std::copy_n(samples.data(), row, out);
  const std::uint8_t* __restrict data = samples.data();
  for (std::size_t i = row; i < samples.size(); ++i) {
    out[i] = static_cast<std::uint8_t>(data[i] - data[i - row]);
  }
}

/// The inverse, in place.
void restore_samples(std::size_t row, std::span<std::uint8_t> samples) {
  for (std::size_t start = row; start < samples.size(); start += row) {
    const std::uint8_t* __restrict above = samples.data() + start - row;
    std::uint8_t* __restrict here = samples.data() + start;
    for (std::size_t x = 0; x < row; ++x) here[x] = static_cast<std::uint8_t>(here[x] + above[x]);
  }
}

/// The same of radiances, of their bits as integers: neighbours differ in the lower bits.
void take_differences(std::span<const float> samples,
                      std::size_t row,
                      std::uint16_t* __restrict lower,
                      std::uint8_t* __restrict third,
                      std::uint8_t* __restrict fourth) {
  const std::vector<float> none(row, 0.0F);
  for (std::size_t start = 0; start < samples.size(); start += row) {
    const float* __restrict here = samples.data() + start;
    const float* __restrict above = start == 0 ? none.data() : here - row;
    for (std::size_t x = 0; x < row; ++x) {
      const std::uint32_t value =
          zigzag(std::bit_cast<std::uint32_t>(here[x]) - std::bit_cast<std::uint32_t>(above[x]));
      lower[start + x] = static_cast<std::uint16_t>(value);
      third[start + x] = static_cast<std::uint8_t>(value >> 16U);
      fourth[start + x] = static_cast<std::uint8_t>(value >> 24U);
    }
  }
}

void restore_radiances(std::size_t row,
                       const std::uint16_t* __restrict lower,
                       const std::uint8_t* __restrict third,
                       const std::uint8_t* __restrict fourth,
                       std::span<float> samples) {
  const std::vector<float> none(row, 0.0F);
  for (std::size_t start = 0; start < samples.size(); start += row) {
    float* __restrict here = samples.data() + start;
    const float* __restrict above = start == 0 ? none.data() : here - row;
    for (std::size_t x = 0; x < row; ++x) {
      const std::uint32_t value = lower[start + x] | (std::uint32_t{third[start + x]} << 16U) |
                                  (std::uint32_t{fourth[start + x]} << 24U);
      here[x] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(above[x]) + from_zigzag(value));
    }
  }
}

}  // namespace

struct FrameCodec::Contexts {
  ZSTD_CCtx* compressor = ZSTD_createCCtx();
  ZSTD_DCtx* decompressor = ZSTD_createDCtx();

  Contexts() {
    if (compressor == nullptr || decompressor == nullptr) {
      free();
      throw std::bad_alloc();
    }
    // A library that does not know it compresses less, and no result changes.
    ZSTD_CCtx_setParameter(compressor, ZSTD_c_literalCompressionMode, ZSTD_ps_enable);
  }
  Contexts(const Contexts&) = delete;
  Contexts& operator=(const Contexts&) = delete;
  ~Contexts() { free(); }
  void free() const {
    ZSTD_freeCCtx(compressor);
    ZSTD_freeDCtx(decompressor);
  }

  /// Appends the compressed bytes. @return how many
  std::size_t append(std::span<const std::uint8_t> bytes,
                     int level,
                     std::vector<std::uint8_t>& out) {
    const std::size_t at = out.size();
    out.resize(at + ZSTD_compressBound(bytes.size()));
    ZSTD_CCtx_setParameter(compressor, ZSTD_c_compressionLevel, level);
    const std::size_t size =
        ZSTD_compress2(compressor, out.data() + at, out.size() - at, bytes.data(), bytes.size());
    // The room is enough by ZSTD_compressBound; what is left is a lack of memory.
    if (ZSTD_isError(size) != 0) throw std::bad_alloc();
    out.resize(at + size);
    return size;
  }

  bool expand(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out) {
    const std::size_t size =
        ZSTD_decompressDCtx(decompressor, out.data(), out.size(), bytes.data(), bytes.size());
    return ZSTD_isError(size) == 0 && size == out.size();
  }
};

FrameCodec::FrameCodec() : contexts_(std::make_unique<Contexts>()) {}
FrameCodec::~FrameCodec() = default;

std::size_t largest_encoded_bytes(std::size_t samples, std::size_t sample_bytes) {
  const std::size_t packed = ZSTD_compressBound(samples);
  return sizeof(Header) + (sample_bytes == 1 ? packed : 2 * packed + 2 * samples);
}

std::span<const std::uint8_t> FrameCodec::encode(const renderer::CameraFrame& frame) {
  Header header = header_of(frame);
  const std::size_t row = static_cast<std::size_t>(header.width_px) * header.channels;
  const std::size_t samples = row * header.height_px;
  std::vector<std::uint8_t>& bytes = encoded_;
  bytes.resize(sizeof header);
  bytes.reserve(largest_encoded_bytes(samples, header.linear != 0 ? 4 : 1));
  third_.resize(samples);
  if (header.linear == 0) {
    take_differences(frame.image.data, row, third_.data());
    header.part_bytes[0] = contexts_->append(third_, kHuffmanOnly, bytes);
  } else {
    fourth_.resize(samples);
    lower_.resize(samples);
    take_differences(frame.radiance.data, row, lower_.data(), third_.data(), fourth_.data());
    header.part_bytes[0] = contexts_->append(third_, kHuffmanOnly, bytes);
    header.part_bytes[1] = contexts_->append(fourth_, kFastSearch, bytes);
    header.part_bytes[2] = 2 * samples;
    const std::size_t at = bytes.size();
    bytes.resize(at + 2 * samples);
    std::memcpy(bytes.data() + at, lower_.data(), 2 * samples);
  }
  std::memcpy(bytes.data(), &header, sizeof header);
  header.crc32 = crc32_of(std::span(bytes).subspan(kCheckedFrom));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

Result<renderer::CameraFrame> FrameCodec::decode(std::span<const std::uint8_t> bytes,
                                                 const renderer::CameraRequest& request) {
  Header header;
  if (bytes.size() < sizeof header) return damaged();
  std::memcpy(&header, bytes.data(), sizeof header);
  if (!is_picture_of(header, request) || header.crc32 != crc32_of(bytes.subspan(kCheckedFrom))) {
    return damaged();
  }
  std::array<std::span<const std::uint8_t>, 3> parts;
  bytes = bytes.subspan(sizeof header);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (header.part_bytes[i] > bytes.size()) return damaged();
    parts[i] = bytes.first(header.part_bytes[i]);
    bytes = bytes.subspan(header.part_bytes[i]);
  }
  renderer::CameraFrame frame = frame_of(header, request);
  const std::size_t row = static_cast<std::size_t>(header.width_px) * header.channels;
  if (header.linear == 0) {
    frame.image = Image(header.width_px, header.height_px, header.channels);
    if (!contexts_->expand(parts[0], frame.image.data)) return damaged();
    restore_samples(row, frame.image.data);
    return frame;
  }
  const std::size_t samples = row * header.height_px;
  third_.resize(samples);
  fourth_.resize(samples);
  lower_.resize(samples);
  if (!contexts_->expand(parts[0], third_) || !contexts_->expand(parts[1], fourth_) ||
      parts[2].size() != 2 * samples) {
    return damaged();
  }
  std::memcpy(lower_.data(), parts[2].data(), 2 * samples);
  frame.radiance = RadianceImage(header.width_px, header.height_px, header.channels);
  restore_radiances(row, lower_.data(), third_.data(), fourth_.data(), frame.radiance.data);
  return frame;
}

}  // namespace overfly::server
