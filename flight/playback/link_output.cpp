#include "flight/playback/link_output.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "flight/mavlink/link/byte_link.hpp"
#include "flight/mavlink/link/open_byte_link.hpp"

namespace overfly::flight::playback {
namespace {

using mavlink::ByteLink;

constexpr std::chrono::seconds kReopenAfter{1};

class LinkOutput final : public PlaybackOutput {
 public:
  LinkOutput(std::unique_ptr<PlaybackRecords> records, mavlink::LinkAddress address)
      : records_(std::move(records)), address_(std::move(address)) {}

  Status open(const std::atomic<bool>* /*stop*/) override {
    auto link = mavlink::open_byte_link(address_, false, true);
    if (!link) return link.error();
    link_ = std::move(*link);
    address_ = link_->address();
    heard_.fill(false);
    return {};
  }
  [[nodiscard]] std::string place() const override { return address_.text(); }

  void wait(TimePoint now, std::chrono::milliseconds patience) override {
    if (!link_ && now >= retry_ && !open(nullptr)) retry_ = now + kReopenAfter;
    std::vector<pollfd> descriptors;
    if (link_) link_->add_to_poll(descriptors);
    (void)::poll(descriptors.data(), descriptors.size(), static_cast<int>(patience.count()));
    if (!link_) return;
    const auto hear = [this](mavlink::PeerId peer, std::span<const std::uint8_t> /*bytes*/) {
      heard_[peer] = true;
    };
    if (link_->exchange(now, hear, [](mavlink::PeerId /*peer*/) {})) return;
    link_.reset();
    retry_ = now + kReopenAfter;
  }

  [[nodiscard]] bool is_heard() const override {
    if (!link_) return false;
    if (address_.kind != mavlink::LinkKind::kUdpListen) return link_->connected();
    return std::find(heard_.begin(), heard_.end(), true) != heard_.end();
  }

  Result<std::optional<std::int64_t>> next_us() override {
    if (!next_) {
      Result<std::optional<PlaybackRecords::Record>> record = records_->next();
      if (!record) return record.error();
      next_ = *record;
    }
    return next_ ? std::optional(next_->t_us) : std::nullopt;
  }
  Status send(PlaybackSummary& summary) override {
    ++(send_to_all(next_->frame) ? summary.sent : summary.unsent);
    next_.reset();
    return {};
  }
  Status seek(std::int64_t t_us) override {
    next_.reset();
    return records_->seek(t_us);
  }
  /// Sends what waits in a buffer of the link.
  Status finish() override {
    wait({}, std::chrono::milliseconds(0));
    return {};
  }
  [[nodiscard]] std::int64_t duration_us() const override { return records_->duration_us(); }
  [[nodiscard]] std::uint64_t count() const override { return records_->count(); }

 private:
  bool send_to_all(std::span<const std::uint8_t> frame) {
    if (!link_) return false;
    if (address_.kind != mavlink::LinkKind::kUdpListen) return link_->send(0, frame);
    bool sent = false;
    for (mavlink::PeerId peer = 0; peer < mavlink::kMaxPeers; ++peer) {
      if (heard_[peer]) sent = link_->send(peer, frame) || sent;
    }
    return sent;
  }

  std::unique_ptr<PlaybackRecords> records_;
  std::optional<PlaybackRecords::Record> next_;
  mavlink::LinkAddress address_;
  std::unique_ptr<ByteLink> link_;
  std::array<bool, mavlink::kMaxPeers> heard_{};
  TimePoint retry_;
};

}  // namespace

std::unique_ptr<PlaybackOutput> link_output(std::unique_ptr<PlaybackRecords> records,
                                            const mavlink::LinkAddress& address) {
  return std::make_unique<LinkOutput>(std::move(records), address);
}

}  // namespace overfly::flight::playback
