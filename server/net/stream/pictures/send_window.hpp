// Limits the bytes of pictures that are on the way to a client. Pure: the caller provides the time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace overfly::net {

/// All else that is sent, such as the clock, waits behind the pictures on the way. Therefore they
/// have together at most the bytes that the link carries in kMostDelayNs. The limit
/// follows the link: it shrinks at once, and doubles each second in which pictures wait for it.
class SendWindow {
 public:
  static constexpr std::int64_t kMostDelayNs = 400'000'000;
  static constexpr std::size_t kFirstBytes = std::size_t{32} << 10U;
  static constexpr std::size_t kLeastBytes = std::size_t{16} << 10U;
  static constexpr std::size_t kMostBytes = std::size_t{256} << 10U;
  /// After this time a picture counts as arrived.
  static constexpr std::int64_t kArrivedByNs = 5'000'000'000;

  /// Whether a picture of this size may be sent. One may always be on the way.
  [[nodiscard]] bool has_room(std::size_t bytes) const;
  /// Whether the client, not the time of drawing, leaves no room.
  [[nodiscard]] bool link_is_full(std::size_t bytes) const;
  /// A picture of a stream is being drawn; its size is a guess.
  void reserve(std::uint32_t stream, std::size_t bytes, std::int64_t now_ns);
  /// That picture is sent.
  void sent(std::uint32_t stream, std::uint32_t sequence, std::size_t bytes);
  /// It is not sent, because it could not be drawn or is not needed any more.
  void release(std::uint32_t stream);
  /// The client has the pictures of a stream up to this number.
  void arrived(std::uint32_t stream, std::uint32_t sequence);
  /// Pictures of a stream that is not subscribed any more count no longer.
  void forget(std::uint32_t stream);
  /// To be called regularly while there are pictures to be sent.
  /// @param waits  a picture that is due waits for the client
  void note(bool waits, std::int64_t now_ns);

  [[nodiscard]] std::size_t limit_bytes() const { return limit_bytes_; }
  [[nodiscard]] std::size_t bytes_on_the_way() const;

 private:
  void close_period(std::int64_t now_ns);

  struct Sent {
    std::uint32_t stream = 0;
    std::optional<std::uint32_t> sequence;  ///< empty while it is being drawn
    std::size_t bytes = 0;
    std::int64_t since_ns = 0;
  };
  std::vector<Sent> on_the_way_;
  std::size_t limit_bytes_ = kFirstBytes;
  bool waits_ = false;
  bool carries_ = false;  ///< pictures are on the way
  std::int64_t noted_ns_ = 0;
  std::int64_t period_began_ns_ = 0;
  std::int64_t waited_ns_ = 0;     ///< in the period
  std::int64_t carried_ns_ = 0;    ///< likewise: while pictures were on the way
  std::size_t arrived_bytes_ = 0;  ///< likewise
  std::size_t most_bytes_ = 0;     ///< on the way at a time, likewise
};

}  // namespace overfly::net
