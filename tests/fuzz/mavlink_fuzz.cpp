// MAVLink frames on a link and in a recording, with the messages that a flight needs.
//
// The first byte gives the number of bytes in front of each frame, and where the input is cut in
// two.
#include <array>

#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/messages.hpp"

namespace {

using namespace overfly::flight::mavlink;

void decode(const Frame& frame) {
  (void)boot_time_ns(frame);
  (void)decode_heartbeat(frame);
  (void)decode_system_time(frame);
  (void)decode_gps_raw(frame);
  (void)decode_attitude(frame);
  (void)decode_attitude_quaternion(frame);
  (void)decode_local_position(frame);
  (void)decode_global_position(frame);
  (void)decode_sim_state(frame);
  (void)decode_hil_state_quaternion(frame);
  (void)decode_simstate(frame);
  (void)decode_imu(frame);
  (void)decode_ahrs2(frame);
  (void)decode_status_text(frame);
  // What was decoded can be encoded again, unless the peer's messages are longer than the table's.
  (void)encode_frame(frame);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  FrameFinder finder(data[0] % 9U);
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  const std::size_t cut = bytes.size() * (data[0] / 9U) / 28U;
  std::size_t at = 0;
  for (const std::size_t end : std::array{cut, bytes.size()}) {
    while (true) {
      const FrameFinder::Found found =
          finder.next(bytes.subspan(at, end - at), end == bytes.size());
      at += found.consumed_bytes;
      if (!found.frame) break;
      decode(*found.frame);
    }
  }
  return 0;
}
