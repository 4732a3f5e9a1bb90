// One client of the WebSocket: understands its messages and decides what it is sent. Knows no
// socket and no clock; not thread-safe: the connection calls it from its strand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/engine/run_manager.hpp"
#include "server/net/client_message.hpp"
#include "server/net/picture_streams.hpp"
#include "server/net/run_watch.hpp"
#include "server/net/viewer_port.hpp"

namespace overfly::net {

class Viewer {
 public:
  /// Both must outlive the viewer.
  Viewer(engine::RunManager& runs, ViewerPort& port) : runs_(runs), port_(port) {}

  /// Sends `hello`.
  void greet(const std::string& connection_name);
  /// Takes one text message and answers it. @param now_ns  monotonic wall clock, here and below
  void handle(const std::string& text, std::int64_t now_ns);
  /// Sends what is due.
  void tick(std::int64_t now_ns);
  void picture_ready(const PictureTicket& ticket,
                     const Result<engine::Picture>& picture,
                     std::int64_t now_ns);
  void picture_sent(const PictureTicket& ticket, std::int64_t now_ns);

  /// When tick() is wanted next, from now; empty while nothing can become due by itself.
  [[nodiscard]] std::optional<std::int64_t> tick_after_ns() const;

 private:
  struct CommandVisitor;
  Status attach(const AttachCommand& command);
  void detach();
  Status seek(const SeekCommand& command);
  Status step(const StepCommand& command);
  void pump_pictures(std::int64_t now_ns);

  engine::RunManager& runs_;
  ViewerPort& port_;
  std::string run_id_;
  std::optional<RunWatch> watch_;
  PictureStreams pictures_;
  bool streams_due_ = false;
};

}  // namespace overfly::net
