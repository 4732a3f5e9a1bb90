#include "core/measure/crc32.hpp"

#include <libdeflate.h>

namespace overfly {

std::uint32_t crc32_of(const Image& image) {
  return libdeflate_crc32(0, image.data.data(), image.data.size());
}

}  // namespace overfly
