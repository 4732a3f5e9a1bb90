// One client of the dashboard's WebSocket: parses its messages and decides what it is sent.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/net/http/http_message.hpp"
#include "server/net/stream/client_message.hpp"
#include "server/net/stream/picture_streams.hpp"
#include "server/net/stream/playback_clock.hpp"
#include "server/net/stream/run_watch.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

class Viewer final : public StreamClient {
 public:
  /// @param port  must outlive the viewer
  /// @param access  which `hello` states: a page offers no changes to one who may not make them
  explicit Viewer(ViewerPort& port, Access access = Access::kOperator)
      : port_(port), access_(access) {}

  /// Sends `hello`.
  void greet(const std::string& connection_name) override;
  /// Takes one text message and answers it, at once or, while a run is being opened, after that.
  /// Messages are processed in order.
  void take_text(const std::string& text, std::int64_t now_ns) override;
  /// Answered as a message that could not be parsed.
  void take_binary(std::span<const std::uint8_t> bytes, std::int64_t now_ns) override;
  [[nodiscard]] bool full() const override { return waiting_.size() >= kMaxWaiting; }
  void run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline,
                  std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;
  void picture_ready(const PictureTicket& ticket,
                     const Result<server::Picture>& picture,
                     std::int64_t now_ns) override;
  void picture_sent(const PictureTicket& ticket, std::int64_t now_ns) override;
  [[nodiscard]] std::optional<std::int64_t> tick_after_ns() const override;

 private:
  static constexpr std::size_t kMaxWaiting = 64;
  struct CommandVisitor;
  /// A `watch` that waits for its run.
  struct Opening {
    std::optional<std::int64_t> request;
    WatchCommand command;
  };
  struct SentClock {
    std::int64_t t_ns = -1;
    bool playing = false;
    bool live = false;
    bool loop = false;
    double speed = 0.0;
    std::optional<PlaybackClock::Range> range;
    bool operator==(const SentClock&) const = default;
  };
  void carry_out(const std::string& text, std::int64_t now_ns);
  /// True if the command was carried out or rejected without opening a run.
  bool watch_known(const WatchCommand& command, Status* status);
  void watch(const WatchCommand& command, std::shared_ptr<const server::RunTimeline> timeline);
  Status unwatch(const UnwatchCommand& command);
  Status align(const AlignCommand& command);
  Status seek(const SeekCommand& command);
  Status step(const StepCommand& command);
  /// The run of a command; an empty id means the first one. Errors: kConflict if it is not watched.
  Result<RunWatch*> watched(const std::string& run_id);
  /// Takes in what was recorded since, and lets the clock go on.
  void refresh(std::int64_t now_ns);
  void set_extent();
  void send_playback(std::int64_t now_ns);
  void pump_pictures(std::int64_t now_ns);

  ViewerPort& port_;
  Access access_;
  std::optional<Opening> opening_;
  std::deque<std::string> waiting_;  ///< messages received after the `watch` in progress
  std::vector<std::unique_ptr<RunWatch>> watches_;  ///< in the order of their commands
  PlaybackClock clock_;
  PictureStreams pictures_;
  bool pictures_due_ = false;
  bool playback_due_ = false;
  SentClock clock_sent_;
  PlaybackClock::Extent extent_sent_;
  std::optional<std::int64_t> playback_at_ns_;  ///< when it was sent last
};

}  // namespace overfly::net
