// One viewer's session with one run: its playback cursor, and the text messages that are due.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/net/stream/playback_cursor.hpp"
#include "server/net/stream/playback_state.hpp"
#include "server/net/stream/row_feed.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

class RunWatch {
 public:
  RunWatch(std::shared_ptr<const server::RunTimeline> timeline,
           const std::map<std::string, std::size_t>& resume);

  [[nodiscard]] const server::RunTimeline& timeline() const { return *timeline_; }
  [[nodiscard]] PlaybackCursor& cursor() { return cursor_; }
  [[nodiscard]] const PlaybackCursor& cursor() const { return cursor_; }

  /// Advances the cursor to now and takes in newly recorded data.
  void refresh(std::int64_t now_ns);
  /// Sends the messages that are due: `run`, `rows`, `estimators`, `metrics` and `playback`. Rows
  /// wait while the connection has much unsent data; none is lost, because the run keeps them.
  void send_due(ViewerPort* port, std::int64_t now_ns);
  /// Sets the alignment of the estimates. Errors: as server::check_alignment.
  Status align(const std::string& mode);
  /// Makes the next send_due() send `playback` regardless of its rate.
  void cursor_commanded() { playback_due_ = true; }
  /// True while rows wait because of unsent data.
  [[nodiscard]] bool behind() const { return behind_; }

 private:
  struct SentCursor {
    std::int64_t t_ns = -1;
    bool playing = false;
    bool live = false;
    bool loop = false;
    double speed = 0.0;
    bool operator==(const SentCursor&) const = default;
  };
  void send_run(ViewerPort* port, std::int64_t now_ns);
  void send_rows(ViewerPort* port, std::int64_t now_ns);
  void send_estimators(ViewerPort* port, std::int64_t now_ns);
  void send_metrics(ViewerPort* port);
  void send_playback(ViewerPort* port, std::int64_t now_ns);

  std::shared_ptr<const server::RunTimeline> timeline_;
  server::Audience::Seat seat_;
  RowFeed feed_;
  PlaybackCursor cursor_;
  EstimatePlaces places_;
  std::optional<std::uint64_t> revision_;       ///< last revision seen by the cursor
  std::optional<std::uint64_t> rows_revision_;  ///< revision of the rows sent last
  std::optional<std::uint64_t> run_revision_;
  std::optional<std::uint64_t> estimators_revision_;
  std::optional<std::uint64_t> metrics_revision_;
  std::optional<std::int64_t> rows_at_ns_;  ///< when they were sent last
  std::optional<std::int64_t> run_at_ns_;
  std::optional<std::int64_t> estimators_at_ns_;
  std::optional<std::int64_t> playback_at_ns_;
  server::RunStatus status_sent_ = server::RunStatus::kQueued;
  std::string run_sent_;
  std::string estimators_sent_;
  std::string metrics_sent_;
  SentCursor cursor_sent_;
  std::int64_t end_sent_ns_ = -1;
  bool playback_due_ = true;
  bool behind_ = false;
};

}  // namespace overfly::net
