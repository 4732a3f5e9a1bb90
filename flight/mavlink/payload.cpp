#include "flight/mavlink/payload.hpp"

#include "core/text/printable_text.hpp"

namespace overfly::flight::mavlink {

std::string PayloadReader::text(std::size_t offset, std::size_t length) const {
  if (offset >= payload_.size()) return {};
  return printable_text(payload_.subspan(offset, std::min(length, payload_.size() - offset)));
}

}  // namespace overfly::flight::mavlink
