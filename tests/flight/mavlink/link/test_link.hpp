// A link whose time is made by the test, and frames on it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "flight/mavlink/link/frame_link.hpp"
#include "tests/flight/logs/log_bytes.hpp"

namespace overfly::flight::mavlink {

using std::chrono::milliseconds;
using testing::attitude_payload;
using testing::Bytes;
using testing::frame_bytes;

inline constexpr std::uint32_t kAttitudeMessage = 30;
inline constexpr std::uint32_t kHeartbeatId = 0;

inline Bytes attitude_frame(std::uint8_t sequence, std::uint8_t system = 1) {
  return frame_bytes(kAttitudeMessage, attitude_payload(sequence, 1, 1, 1), sequence, system);
}

/// A link whose time is made by the test.
struct TestLink {
  LinkClock::time_point now;
  std::unique_ptr<FrameLink> link;
  std::vector<std::string> frames;  ///< "system:sequence"

  explicit TestLink(const std::string& address, LinkOptions options = {}) {
    Result<std::unique_ptr<FrameLink>> made =
        FrameLink::create(*parse_link_address(address, "link"), options, now);
    EXPECT_TRUE(made.ok()) << made.error().message;
    if (made.ok()) link = std::move(*made);
  }
  void step(milliseconds patience = milliseconds(0)) {
    link->step(now, patience, [&](const Frame& frame) {
      frames.push_back(std::to_string(frame.system) + ":" + std::to_string(frame.sequence));
    });
  }
  /// Steps until `done`; the kernel may need a moment to deliver what was sent.
  template <typename Done>
  bool step_until(const Done& done) {
    for (int i = 0; i < 500 && !done(); ++i) step(milliseconds(10));
    return done();
  }
  bool step_until_frames(std::size_t count) {
    return step_until([&] { return frames.size() >= count; });
  }
  [[nodiscard]] std::uint16_t port() const { return link->address().port; }
};

/// System and message of each frame that a peer got.
inline std::vector<std::string> sent_frames_in(const Bytes& bytes) {
  FrameFinder finder;
  std::vector<std::string> frames;
  std::span<const std::uint8_t> rest = bytes;
  while (true) {
    const FrameFinder::Found found = finder.next(rest, true);
    if (!found.frame) return frames;
    frames.push_back(std::to_string(found.frame->system) + ":" +
                     std::to_string(found.frame->message_id));
    rest = rest.subspan(found.consumed_bytes);
  }
}

inline const Bytes kBeat = {0, 0, 0, 0, 6, 8, 0, 4, 3};

}  // namespace overfly::flight::mavlink
