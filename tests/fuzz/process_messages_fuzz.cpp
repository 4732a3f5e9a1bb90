// What an estimator sends through the process door: messages and their fields.
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <memory>

#include "tests/fuzz/input_folder.hpp"
#include "vo_bridges/process/link/channel.hpp"
#include "vo_bridges/process/link/messages.hpp"

namespace overfly::process {
namespace {

VoFrame frame_under_way() {
  VoFrame frame;
  frame.index = 7;
  frame.intrinsics =
      PinholeCamera::from_fov(64, 48, rad_from_deg(80.0), FovAxis::kHorizontal).value();
  return frame;
}

void understand(const Message& message, const VoFrame& frame, FigureIntake* figures) {
  switch (message.type) {
    case MessageType::kHello:
      (void)hello_from(message.payload);
      break;
    case MessageType::kAnswer:
      (void)answer_from(message.payload, frame, figures);
      break;
    case MessageType::kDebugImage:
      (void)debug_image_from(message.payload, frame);
      break;
    case MessageType::kMapPoints:
      (void)map_points_from(message.payload, frame);
      break;
    case MessageType::kParameters:
      (void)parameters_from(message.payload);
      break;
    case MessageType::kLog:
      (void)log_line_from(message.payload);
      break;
    default:
      break;
  }
}

}  // namespace
}  // namespace overfly::process

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly::process;
  constexpr std::size_t kFitsTheSocket = 64U << 10U;
  if (size > kFitsTheSocket) return 0;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) std::abort();
  if (::send(ends[1], data, size, MSG_DONTWAIT) != static_cast<ssize_t>(size)) std::abort();
  ::close(ends[1]);
  Channel channel{overfly::FileDescriptor(ends[0])};
  static const overfly::VoFrame frame = frame_under_way();
  FigureIntake figures;
  channel.begin_frame(64 * 48);
  // The other side has closed: every call ends with a message or an error.
  for (;;) {
    const auto message = channel.next(Clock::now() + std::chrono::seconds(5));
    if (!message) return 0;
    if (!*message) std::abort();
    understand(**message, frame, &figures);
    (void)figures.take_notes();
  }
}
