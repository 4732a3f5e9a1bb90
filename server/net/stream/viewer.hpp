// One WebSocket client: parses its messages and decides what it is sent. Uses no socket and no
// clock. Not thread-safe: the connection calls it from its strand.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "server/net/stream/client_message.hpp"
#include "server/net/stream/picture_streams.hpp"
#include "server/net/stream/run_watch.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

class Viewer {
 public:
  /// @param port  must outlive the viewer
  explicit Viewer(ViewerPort& port) : port_(port) {}

  /// Sends `hello`.
  void greet(const std::string& connection_name);
  /// Takes one text message and answers it, at once or, while a run is being opened, after that.
  /// Messages are processed in order.
  /// @param now_ns  monotonic wall clock, here and below
  void handle(const std::string& text, std::int64_t now_ns);
  /// True if so many messages wait for a run to open that no more should be read.
  [[nodiscard]] bool full() const { return waiting_.size() >= kMaxWaiting; }
  void run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline, std::int64_t now_ns);
  /// Sends the messages that are due.
  void tick(std::int64_t now_ns);
  void picture_ready(const PictureTicket& ticket,
                     const Result<server::Picture>& picture,
                     std::int64_t now_ns);
  void picture_sent(const PictureTicket& ticket, std::int64_t now_ns);

  /// Time until the next tick() is needed; empty if nothing becomes due by itself.
  [[nodiscard]] std::optional<std::int64_t> tick_after_ns() const;

 private:
  static constexpr std::size_t kMaxWaiting = 64;
  struct CommandVisitor;
  /// An `attach` that waits for its run.
  struct Opening {
    std::optional<std::int64_t> request;
    AttachCommand command;
  };
  void carry_out(const std::string& text, std::int64_t now_ns);
  void attach(const AttachCommand& command, std::shared_ptr<const server::RunTimeline> timeline);
  void detach();
  Status align(const AlignCommand& command);
  Status seek(const SeekCommand& command);
  Status step(const StepCommand& command);
  void pump_pictures(std::int64_t now_ns);

  ViewerPort& port_;
  std::optional<Opening> opening_;
  std::deque<std::string> waiting_;  ///< messages received after the `attach` in progress
  std::string run_id_;
  std::optional<RunWatch> watch_;
  PictureStreams pictures_;
  bool streams_due_ = false;
};

}  // namespace overfly::net
