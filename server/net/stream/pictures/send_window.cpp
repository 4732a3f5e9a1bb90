#include "server/net/stream/pictures/send_window.hpp"

#include <algorithm>
#include <numeric>

namespace overfly::net {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000'000;
/// Of a period in which pictures wait for more than this share, the window is fitted to the link.
constexpr double kShareWaited = 0.05;

}  // namespace

std::size_t SendWindow::bytes_on_the_way() const {
  return std::accumulate(on_the_way_.begin(),
                         on_the_way_.end(),
                         std::size_t{0},
                         [](std::size_t sum, const Sent& sent) { return sum + sent.bytes; });
}

bool SendWindow::has_room(std::size_t bytes) const {
  return on_the_way_.empty() || bytes_on_the_way() + bytes <= limit_bytes_;
}

bool SendWindow::link_is_full(std::size_t bytes) const {
  const std::size_t sent_bytes = std::accumulate(
      on_the_way_.begin(),
      on_the_way_.end(),
      std::size_t{0},
      [](std::size_t sum, const Sent& sent) { return sent.sequence ? sum + sent.bytes : sum; });
  return sent_bytes > 0 && sent_bytes + bytes > limit_bytes_;
}

void SendWindow::reserve(std::uint32_t stream, std::size_t bytes, std::int64_t now_ns) {
  on_the_way_.push_back({stream, std::nullopt, bytes, now_ns});
}

void SendWindow::sent(std::uint32_t stream, std::uint32_t sequence, std::size_t bytes) {
  for (Sent& sent : on_the_way_) {
    if (sent.stream != stream || sent.sequence) continue;
    sent.sequence = sequence;
    sent.bytes = bytes;
  }
  most_bytes_ = std::max(most_bytes_, bytes_on_the_way());
}

void SendWindow::release(std::uint32_t stream) {
  std::erase_if(on_the_way_,
                [&](const Sent& sent) { return sent.stream == stream && !sent.sequence; });
}

void SendWindow::arrived(std::uint32_t stream, std::uint32_t sequence) {
  std::erase_if(on_the_way_, [&](const Sent& sent) {
    const bool has = sent.stream == stream && sent.sequence && *sent.sequence <= sequence;
    if (has) arrived_bytes_ += sent.bytes;
    return has;
  });
}

void SendWindow::forget(std::uint32_t stream) {
  std::erase_if(on_the_way_, [&](const Sent& sent) { return sent.stream == stream; });
}

void SendWindow::note(bool waits, std::int64_t now_ns) {
  std::erase_if(on_the_way_,
                [&](const Sent& sent) { return now_ns - sent.since_ns > kArrivedByNs; });
  if (period_began_ns_ == 0) period_began_ns_ = noted_ns_ = now_ns;
  if (waits_) waited_ns_ += now_ns - noted_ns_;
  if (carries_) carried_ns_ += now_ns - noted_ns_;
  noted_ns_ = now_ns;
  waits_ = waits;
  carries_ = std::any_of(on_the_way_.begin(), on_the_way_.end(), [](const Sent& sent) {
    return sent.sequence.has_value();
  });
  if (now_ns - period_began_ns_ >= kPeriodNs) close_period(now_ns);
}

void SendWindow::close_period(std::int64_t now_ns) {
  const auto period = static_cast<double>(now_ns - period_began_ns_);
  if (static_cast<double>(waited_ns_) > kShareWaited * period) {
    // Pictures of all streams are due at the same instants: between these the link may rest.
    const auto busy = static_cast<double>(std::max<std::int64_t>(carried_ns_, 1));
    const double carried = static_cast<double>(arrived_bytes_) / busy * kMostDelayNs;
    const auto carried_bytes =
        static_cast<std::size_t>(std::min(carried, static_cast<double>(kMostBytes)));
    limit_bytes_ = std::clamp(std::min(2 * limit_bytes_, carried_bytes), kLeastBytes, kMostBytes);
  } else {
    // Room that is not used would fill at once when the link becomes slow.
    limit_bytes_ = std::min(limit_bytes_, std::max(2 * most_bytes_, kFirstBytes));
  }
  period_began_ns_ = now_ns;
  waited_ns_ = 0;
  carried_ns_ = 0;
  arrived_bytes_ = 0;
  most_bytes_ = bytes_on_the_way();
}

}  // namespace overfly::net
