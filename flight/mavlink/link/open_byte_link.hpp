// Opens a link by its address.
#pragma once

#include <memory>

#include "flight/mavlink/link/byte_link.hpp"

namespace overfly::flight::mavlink {

/// Opens a link.
/// @param read_only  never sends a byte: every byte goes out through ByteLink::send, which refuses
/// it.
/// @param keeps_silent_peers  "tcp-listen:": a connection keeps its place although nothing is
/// received on it, as from those who only watch.
/// Errors: kInvalidArgument for a read-only "udp:" link, whose peer answers only to what it
/// gets; kConflict if an address to listen on is in use; kNotFound for a missing device; kIo.
[[nodiscard]] Result<std::unique_ptr<ByteLink>> open_byte_link(const LinkAddress& address,
                                                               bool read_only,
                                                               bool keeps_silent_peers = false);

}  // namespace overfly::flight::mavlink
