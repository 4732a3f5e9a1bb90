#include "core/measure/crc32.hpp"

#include <libdeflate.h>

namespace overfly {

std::uint32_t crc32_of(const Image& image) { return crc32_of(std::span(image.data)); }

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
  return libdeflate_crc32(0, bytes.data(), bytes.size());
}

}  // namespace overfly
