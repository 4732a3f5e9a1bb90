#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {

std::string PayloadReader::text(std::size_t offset, std::size_t length) const {
  std::string found;
  for (std::size_t i = offset; i < std::min(offset + length, payload_.size()); ++i) {
    const auto byte = static_cast<char>(payload_[i]);
    if (byte == '\0') break;
    found += byte >= ' ' && byte <= '~' ? byte : '?';
  }
  return found;
}

}  // namespace overfly::flight::mavlink
