// A link as MAVLink frames: reconnection, counts, signatures, and the sender's side.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/link/back_off.hpp"
#include "flight/mavlink/link/byte_link.hpp"
#include "flight/mavlink/link/frame_recorder.hpp"
#include "flight/mavlink/link/signing.hpp"

namespace overfly::flight::mavlink {

using LinkClock = std::chrono::steady_clock;

struct LinkOptions {
  bool read_only = false;           ///< never sends a byte
  std::uint8_t system = 255;        ///< of this program; 255 is usual for ground stations
  std::uint8_t component = 190;     ///< MAV_COMP_ID_MISSIONPLANNER
  Version version = Version::kTwo;  ///< of what is sent
  /// With a key, only frames that are signed with it are accepted; without, signatures are not
  /// checked.
  std::optional<SigningKey> key;
  bool sign = false;                        ///< what is sent, with `key`
  std::uint8_t link_id = 0;                 ///< in signatures
  std::shared_ptr<FrameRecorder> recorder;  ///< of what is received and accepted; may be null
  /// Of a vehicle: connections on "tcp-listen:" may be silent, as those that only watch.
  bool keeps_silent_peers = false;
};

/// Messages of one component.
struct SenderCounts {
  std::uint64_t frames = 0;
  SequenceCounter sequence;
};

struct LinkCounts {
  std::uint64_t received_bytes = 0;
  std::uint64_t received_frames = 0;
  std::uint64_t bad_checksums = 0;
  std::uint64_t skipped_bytes = 0;  ///< that belong to no valid frame
  /// Not signed with the key, or played back.
  std::uint64_t refused_signatures = 0;
  std::uint64_t sent_bytes = 0;
  std::uint64_t failures = 0;  ///< times that opening or using it failed
  std::string last_failure;
};

/// A TCP connection must be established within this time.
inline constexpr std::chrono::seconds kConnectPatience{5};

/// Sends and receives frames, and opens the link again after failures, waiting as BackOff says.
/// Time is an argument. Not thread-safe, but for wake().
class FrameLink {
 public:
  /// Opens the link for the first time. Errors: kInvalidArgument and kConflict as open_byte_link,
  /// and for `sign` without a key or with MAVLink 1. Other failures are tried again by step().
  static Result<std::unique_ptr<FrameLink>> create(const LinkAddress& address,
                                                   const LinkOptions& options,
                                                   LinkClock::time_point now);

  using Take = std::function<void(const Frame&)>;
  /// Waits up to `patience` for bytes, passes on the frames in them, and sends what waits. Frames
  /// that come twice or late are counted and passed on as well.
  void step(LinkClock::time_point now, std::chrono::milliseconds patience, const Take& take);
  /// Ends the waiting of step(), from any thread.
  void wake();

  /// Sends a message to a system, by the way that its last message came; 0: to all that were heard.
  /// MAVLink 1 leaves out extension fields.
  /// Errors: as encode_frame; kConflict on a read-only link. A message that cannot be sent at the
  /// moment is lost, as on any link.
  [[nodiscard]] Status send(std::uint32_t message_id,
                            std::span<const std::uint8_t> payload,
                            std::uint8_t target_system);

  [[nodiscard]] bool connected() const { return link_ && link_->connected(); }
  [[nodiscard]] LinkCounts counts() const;
  /// By system * 256 + component.
  [[nodiscard]] const std::map<std::uint16_t, SenderCounts>& senders() const { return senders_; }
  /// With the actual port if 0 was asked for.
  [[nodiscard]] const LinkAddress& address() const { return address_; }
  [[nodiscard]] const LinkOptions& options() const { return options_; }

 private:
  /// What was received from one peer.
  struct PeerInput {
    FrameFinder finder;
    std::vector<std::uint8_t> bytes;  ///< of an incomplete frame
    bool heard = false;               ///< has sent a valid frame
  };

  FrameLink(LinkAddress address, LinkOptions options, LinkClock::time_point now);
  Status open(LinkClock::time_point now);
  void failed(const Error& error, LinkClock::time_point now);
  /// Forgets what was received from the peer that had a number, and the ways to systems by it. Its
  /// counts stay.
  void forget(PeerId peer);
  void wait(LinkClock::time_point now, std::chrono::milliseconds patience);
  void take_bytes(PeerId peer, std::span<const std::uint8_t> bytes, const Take& take);
  void take_frame(PeerId peer, const FrameFinder::Found& found, const Take& take);
  [[nodiscard]] std::uint64_t signing_time_at(LinkClock::time_point now) const;

  LinkAddress address_;
  LinkOptions options_;
  FileDescriptor wake_;  ///< an eventfd
  std::unique_ptr<ByteLink> link_;
  BackOff back_off_;
  LinkClock::time_point now_;
  LinkClock::time_point opened_;
  LinkClock::time_point retry_;
  std::array<std::unique_ptr<PeerInput>, kMaxPeers> inputs_;
  std::array<std::optional<PeerId>, 256> ways_;  ///< to each system
  std::map<std::uint16_t, SenderCounts> senders_;
  std::optional<SignatureCheck> signatures_;
  std::uint64_t signing_start_ = 0;
  LinkClock::time_point start_;
  std::uint8_t sequence_ = 0;
  LinkCounts counts_;
};

}  // namespace overfly::flight::mavlink
