// Links by UDP. Private to link.
#pragma once

#include <memory>

#include "flight/mavlink/link/byte_link.hpp"

namespace overfly::flight::mavlink {

/// "udp-listen:" and "udp:". Errors: as open_byte_link.
[[nodiscard]] Result<std::unique_ptr<ByteLink>> open_udp(const LinkAddress& address,
                                                         bool read_only);

}  // namespace overfly::flight::mavlink
