#include "flight/mavlink/link/open_byte_link.hpp"

#include "flight/mavlink/link/stream_link.hpp"
#include "flight/mavlink/link/udp_link.hpp"

namespace overfly::flight::mavlink {

Result<std::unique_ptr<ByteLink>> open_byte_link(const LinkAddress& address,
                                                 bool read_only,
                                                 bool keeps_silent_peers) {
  switch (address.kind) {
    case LinkKind::kUdp:
      if (read_only) {
        return Error{ErrorCode::kInvalidArgument,
                     address.text() +
                         ": a read-only link must not send, and this peer answers only to what it "
                         "gets: use udp-listen or tcp"};
      }
      return open_udp(address, read_only);
    case LinkKind::kUdpListen:
      return open_udp(address, read_only);
    case LinkKind::kTcpListen:
      return listen_tcp(address, read_only, keeps_silent_peers);
    case LinkKind::kTcp:
      return connect_tcp(address, read_only);
    default:
      return open_serial(address, read_only);
  }
}

}  // namespace overfly::flight::mavlink
