// A playback onto a MAVLink link.
#pragma once

#include <memory>

#include "flight/mavlink/link/link_address.hpp"
#include "flight/playback/playback_output.hpp"
#include "flight/playback/playback_records.hpp"

namespace overfly::flight::playback {

/// Sends the frames byte by byte; what the other side sends is ignored. Somebody listens when there
/// is a connection, or on `udp-listen:` when a datagram has come; on `udp:` at once. A link that
/// fails is opened again after a second. open() has the errors of open_byte_link.
[[nodiscard]] std::unique_ptr<PlaybackOutput> link_output(std::unique_ptr<PlaybackRecords> records,
                                                          const mavlink::LinkAddress& address);

}  // namespace overfly::flight::playback
