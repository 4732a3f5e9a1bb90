// Interfaces between a connection and the client that it serves.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/view_service.hpp"

namespace overfly::net {

/// Identifies a picture in progress; later calls refer to it by stream and ticket.
struct PictureTicket {
  std::uint32_t stream_id = 0;
  std::uint64_t number = 0;
};

/// While more than this is unsent, no further rows are encoded, and positions of the clock are
/// skipped.
inline constexpr std::size_t kHighWaterBytes = std::size_t{1} << 20U;

class ViewerPort {
 public:
  virtual ~ViewerPort() = default;

  virtual void send_text(std::string text) = 0;
  virtual void send_binary(std::vector<std::uint8_t> message) = 0;
  /// One binary message of both parts. When it has been sent, the connection calls
  /// StreamClient::picture_sent.
  virtual void send_picture(const PictureTicket& ticket,
                            std::vector<std::uint8_t> head,
                            std::shared_ptr<const std::vector<std::uint8_t>> payload) = 0;
  /// Requests a picture; when it is ready, the connection calls StreamClient::picture_ready.
  virtual void draw(const PictureTicket& ticket, const server::PictureRequest& request) = 0;
  /// Opens a run, which may require reading it from disk. The connection calls
  /// StreamClient::run_opened when that is done, never before this returns.
  virtual void open_run(const std::string& run_id) = 0;
  /// The same for the newest run that flies, or else the newest one.
  virtual void open_newest_run() = 0;
  /// Runs slow work on another thread, and what follows from it like the connection's other calls,
  /// never before this returns. What follows is dropped if the connection has ended.
  virtual void work(std::function<std::function<void()>()> slow) = 0;
  /// Maximum rate of each picture stream during real-time flights [Hz]; empty = none.
  [[nodiscard]] virtual std::optional<double> picture_limit_hz() const = 0;
  /// Bytes accepted by send_* that have not been sent yet.
  [[nodiscard]] virtual std::size_t unsent_bytes() const = 0;
};

/// What a connection serves: it takes the client's messages and decides what the client is sent.
/// Uses no socket and no clock. Not thread-safe: the connection calls it from its strand.
class StreamClient {
 public:
  virtual ~StreamClient() = default;

  /// The connection is open.
  virtual void greet(const std::string& connection_name) = 0;
  /// @param now_ns  monotonic wall clock, here and below
  virtual void take_text(const std::string& text, std::int64_t now_ns) = 0;
  virtual void take_binary(std::span<const std::uint8_t> bytes, std::int64_t now_ns) = 0;
  /// True if so many messages wait that no more should be read.
  [[nodiscard]] virtual bool full() const = 0;
  virtual void run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline,
                          std::int64_t now_ns) = 0;
  /// Sends the messages that are due.
  virtual void tick(std::int64_t now_ns) = 0;
  virtual void picture_ready(const PictureTicket& ticket,
                             const Result<server::Picture>& picture,
                             std::int64_t now_ns) = 0;
  virtual void picture_sent(const PictureTicket& ticket, std::int64_t now_ns) = 0;
  /// Time until the next tick() is needed; empty if nothing becomes due by itself.
  [[nodiscard]] virtual std::optional<std::int64_t> tick_after_ns() const = 0;
};

}  // namespace overfly::net
