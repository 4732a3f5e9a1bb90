#include "flight/mavlink/link/frame_link.hpp"

#include <sys/eventfd.h>

#include <algorithm>
#include <utility>

#include "flight/mavlink/link/open_byte_link.hpp"
#include "flight/mavlink/message_table.hpp"

namespace overfly::flight::mavlink {

FrameLink::FrameLink(LinkAddress address, LinkOptions options, LinkClock::time_point now)
    : address_(std::move(address)),
      options_(options),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      now_(now),
      opened_(now),
      retry_(now),
      start_(now) {
  if (!options_.key) return;
  signing_start_ = signing_time(std::chrono::system_clock::now());
  signatures_.emplace(*options_.key, signing_start_);
}

Result<std::unique_ptr<FrameLink>> FrameLink::create(const LinkAddress& address,
                                                     const LinkOptions& options,
                                                     LinkClock::time_point now) {
  if (options.sign && (!options.key || options.version == Version::kOne)) {
    return Error{ErrorCode::kInvalidArgument,
                 address.text() + ": signing needs a key and MAVLink 2"};
  }
  std::unique_ptr<FrameLink> link(new FrameLink(address, options, now));
  if (!link->wake_.open()) {
    return Error{ErrorCode::kIo, address.text() + ": creating an eventfd failed"};
  }
  if (Status status = link->open(now); !status) {
    const ErrorCode code = status.error().code;
    if (code == ErrorCode::kInvalidArgument || code == ErrorCode::kConflict) return status.error();
    link->failed(status.error(), now);
  }
  return link;
}

Status FrameLink::open(LinkClock::time_point now) {
  Result<std::unique_ptr<ByteLink>> link =
      open_byte_link(address_, options_.read_only, options_.keeps_silent_peers);
  if (!link) return link.error();
  link_ = std::move(*link);
  address_ = link_->address();
  opened_ = now;
  return {};
}

void FrameLink::failed(const Error& error, LinkClock::time_point now) {
  link_.reset();
  for (PeerId peer = 0; peer < kMaxPeers; ++peer) forget(peer);
  ++counts_.failures;
  counts_.last_failure = error.message;
  retry_ = now + back_off_.next();
}

void FrameLink::forget(PeerId peer) {
  for (auto& way : ways_) {
    if (way == peer) way.reset();
  }
  std::unique_ptr<PeerInput>& input = inputs_[peer];
  if (!input) return;
  counts_.bad_checksums += input->finder.counts().bad_checksums;
  // Half a frame of the old peer has no other half in the bytes of the new one.
  counts_.skipped_bytes += input->finder.counts().skipped_bytes + input->bytes.size();
  input.reset();
}

void FrameLink::wake() {
  const std::uint64_t one = 1;
  // A full counter wakes as well.
  (void)!::write(wake_.get(), &one, sizeof one);
}

void FrameLink::wait(LinkClock::time_point now, std::chrono::milliseconds patience) {
  std::vector<pollfd> descriptors = {{wake_.get(), POLLIN, 0}};
  if (link_) {
    link_->add_to_poll(descriptors);
  } else {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(retry_ - now);
    patience = std::clamp(left, std::chrono::milliseconds(0), patience);
  }
  (void)::poll(descriptors.data(), descriptors.size(), static_cast<int>(patience.count()));
  std::uint64_t count = 0;
  (void)!::read(wake_.get(), &count, sizeof count);
}

void FrameLink::step(LinkClock::time_point now,
                     std::chrono::milliseconds patience,
                     const Take& take) {
  now_ = now;
  if (!link_ && now >= retry_) {
    if (Status status = open(now); !status) failed(status.error(), now);
  }
  wait(now, patience);
  if (!link_) return;
  const auto take_piece = [&](PeerId peer, std::span<const std::uint8_t> bytes) {
    take_bytes(peer, bytes, take);
  };
  Status status = link_->exchange(now, take_piece, [this](PeerId peer) { forget(peer); });
  const bool may_wait = address_.kind == LinkKind::kTcp && !link_->connected();
  if (status.ok() && may_wait && now - opened_ > kConnectPatience) {
    status = Error{ErrorCode::kIo, address_.text() + ": connecting: no answer within 5 s"};
  }
  if (!status) failed(status.error(), now);
}

void FrameLink::take_bytes(PeerId peer, std::span<const std::uint8_t> bytes, const Take& take) {
  back_off_.reset();
  counts_.received_bytes += bytes.size();
  std::unique_ptr<PeerInput>& input = inputs_[peer];
  if (!input) input = std::make_unique<PeerInput>();
  input->bytes.insert(input->bytes.end(), bytes.begin(), bytes.end());
  const std::span<const std::uint8_t> all = input->bytes;
  std::size_t used = 0;
  while (true) {
    const FrameFinder::Found found = input->finder.next(all.subspan(used), false);
    used += found.consumed_bytes;
    if (!found.frame) break;
    take_frame(peer, found, take);
  }
  // What is left is less than one frame.
  input->bytes.erase(input->bytes.begin(),
                     input->bytes.begin() + static_cast<std::ptrdiff_t>(used));
}

void FrameLink::take_frame(PeerId peer, const FrameFinder::Found& found, const Take& take) {
  const Frame& frame = *found.frame;
  if (signatures_) {
    signatures_->advance(signing_time_at(now_));
    if (!signatures_->accepts(frame, found.bytes)) {
      ++counts_.refused_signatures;
      return;
    }
  }
  if (options_.recorder) options_.recorder->add(found.bytes, std::chrono::system_clock::now());
  const auto sender = static_cast<std::uint16_t>((unsigned{frame.system} << 8U) | frame.component);
  SenderCounts& counts = senders_[sender];
  ++counts.frames;
  ++counts_.received_frames;
  inputs_[peer]->heard = true;
  ways_[frame.system] = peer;
  (void)counts.sequence.take(frame.sequence);
  take(frame);
}

std::uint64_t FrameLink::signing_time_at(LinkClock::time_point now) const {
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(now - start_).count();
  return signing_start_ + static_cast<std::uint64_t>(std::max<std::int64_t>(us, 0)) / 10;
}

Status FrameLink::send(std::uint32_t message_id,
                       std::span<const std::uint8_t> payload,
                       std::uint8_t target_system) {
  if (options_.read_only) {
    return Error{ErrorCode::kConflict, address_.text() + ": the link is read-only"};
  }
  const Frame frame{
      options_.version, sequence_, options_.system, options_.component, message_id, false, payload};
  std::uint64_t timestamp = 0;
  if (options_.sign) {
    // Every signature has a later time than the one before.
    timestamp = std::max(signing_time_at(now_), signatures_->timestamp() + 1);
    signatures_->advance(timestamp);
  }
  const auto bytes = options_.sign
                         ? encode_signed_frame(frame, *options_.key, options_.link_id, timestamp)
                         : encode_frame(frame);
  if (!bytes) return bytes.error();
  ++sequence_;
  const auto send_to = [&](PeerId peer) {
    if (link_ && link_->send(peer, *bytes)) counts_.sent_bytes += bytes->size();
  };
  if (target_system != 0 && ways_[target_system]) {
    send_to(*ways_[target_system]);
  } else if (address_.kind == LinkKind::kUdpListen) {
    for (PeerId peer = 0; peer < kMaxPeers; ++peer) {
      if (inputs_[peer] && inputs_[peer]->heard) send_to(peer);
    }
  } else {
    send_to(0);
  }
  return {};
}

LinkCounts FrameLink::counts() const {
  LinkCounts counts = counts_;
  for (const auto& input : inputs_) {
    if (!input) continue;
    counts.bad_checksums += input->finder.counts().bad_checksums;
    counts.skipped_bytes += input->finder.counts().skipped_bytes;
  }
  return counts;
}

}  // namespace overfly::flight::mavlink
