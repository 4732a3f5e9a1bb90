// Processor time of a session with a live vehicle that sends many messages, by UDP or TCP.
// Usage: live_bench [MESSAGES_PER_SECOND] [SECONDS]     default: 5000, 10
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "core/measure/processor_time.hpp"
#include "flight/live/live_truth.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/mavlink/vehicle/vehicle.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"

namespace overfly::flight {
namespace {

using Clock = std::chrono::steady_clock;

/// Sends two of three messages as attitudes and one as a position, in steps of 1 ms.
/// @return the sender's processor time [s]
double send_messages(testing::PeerSocket& socket, int per_second, double seconds) {
  const double cpu_begin_s = thread_cpu_s();
  const Clock::time_point begin = Clock::now();
  std::uint8_t sequence = 0;
  const testing::Bytes heartbeat = mavlink::PayloadWriter(9)
                                       .put(4, std::uint8_t{1})
                                       .put(5, std::uint8_t{3})
                                       .put(6, std::uint8_t{0x81})
                                       .bytes();
  (void)socket.send(testing::frame_bytes(0, heartbeat, sequence++));
  long sent = 0;
  for (std::uint32_t ms = 0; ms < 1000 * seconds; ++ms) {
    for (const long due = static_cast<long>(per_second) * ms / 1000; sent < due; ++sent) {
      const testing::Bytes frame =
          sent % 3 == 0
              ? testing::frame_bytes(
                    33, testing::global_position_payload(ms, 100, 200, 300000), sequence++)
              : testing::frame_bytes(30, testing::attitude_payload(ms, 0, 0, 1), sequence++);
      if (!socket.send(frame)) return thread_cpu_s() - cpu_begin_s;
    }
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(ms + 1));
  }
  return thread_cpu_s() - cpu_begin_s;
}

void measure(const std::string& kind, int per_second, double seconds) {
  mavlink::VehicleOptions options;
  options.link.read_only = true;
  auto opened =
      mavlink::Vehicle::open(*mavlink::parse_link_address(kind + ":127.0.0.1:0", "link"), options);
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return;
  }
  const std::shared_ptr<mavlink::Vehicle> vehicle = std::move(*opened);
  testing::PeerSocket socket(kind == "udp-listen" ? SOCK_DGRAM : SOCK_STREAM);
  if (!socket.connect_to(vehicle->address().port)) return;
  const double cpu_begin_s = process_cpu_s();
  double sender_cpu_s = 0.0;
  std::thread sender([&] { sender_cpu_s = send_messages(socket, per_second, seconds); });
  const auto truth =
      live::LiveTruth::open(vehicle, LocalFrame(geodetic_from_deg(0.0, 0.0, 0.0)), {}, nullptr);
  sender.join();
  const double session_cpu_s = process_cpu_s() - cpu_begin_s - sender_cpu_s;
  const mavlink::VehicleState state = vehicle->state();
  std::printf("%s: %llu messages taken, %llu lost, %.1f %% of one core, %.1f us a message\n",
              kind.c_str(),
              static_cast<unsigned long long>(state.messages),
              static_cast<unsigned long long>(state.lost_messages),
              100.0 * session_cpu_s / seconds,
              1e6 * session_cpu_s / static_cast<double>(state.messages));
}

}  // namespace
}  // namespace overfly::flight

int main(int argc, char** argv) {
  const int per_second = argc > 1 ? std::atoi(argv[1]) : 5000;
  const double seconds = argc > 2 ? std::atof(argv[2]) : 10.0;
  for (const char* kind : {"udp-listen", "tcp-listen"}) {
    overfly::flight::measure(kind, per_second, seconds);
  }
  return 0;
}
