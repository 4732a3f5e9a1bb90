// Links whose bytes come in order: TCP and serial. Private to link.
#pragma once

#include <memory>

#include "flight/mavlink/link/byte_link.hpp"

namespace overfly::flight::mavlink {

/// "tcp:". The connection is started and established by ByteLink::exchange.
[[nodiscard]] Result<std::unique_ptr<ByteLink>> connect_tcp(const LinkAddress& address,
                                                            bool read_only);
/// "tcp-listen:": one connection at a time; others are closed at once until it ends. A connection
/// on which nothing was received for kSilenceLimit ends when another one comes.
/// @param keeps_silent_peers  it does not
[[nodiscard]] Result<std::unique_ptr<ByteLink>> listen_tcp(const LinkAddress& address,
                                                           bool read_only,
                                                           bool keeps_silent_peers);
/// "serial:": 8 data bits, no parity, 1 stop bit, no flow control; no other program may open the
/// device meanwhile. Errors: kInvalidArgument for a file that is not a terminal device.
[[nodiscard]] Result<std::unique_ptr<ByteLink>> open_serial(const LinkAddress& address,
                                                            bool read_only);

}  // namespace overfly::flight::mavlink
