// One viewer's view of one run: its place on the viewer's clock, and the text messages that are
// due.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/net/stream/row_feed.hpp"
#include "server/net/stream/run_instant.hpp"
#include "server/net/stream/viewer_port.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

class RunWatch {
 public:
  RunWatch(std::string run_id,
           std::shared_ptr<const server::RunTimeline> timeline,
           std::int64_t offset_ns,
           const std::map<std::string, std::size_t>& resume);

  [[nodiscard]] const std::string& run_id() const { return run_id_; }
  [[nodiscard]] const server::RunTimeline& timeline() const { return *timeline_; }

  /// Takes in newly recorded data. @return true if there were any
  bool refresh();
  /// Time of the viewer's clock at the run's beginning and at its last frame so far.
  [[nodiscard]] std::int64_t begin_ns() const { return offset_ns_; }
  [[nodiscard]] std::int64_t end_ns() const { return offset_ns_ + end_ns_; }
  [[nodiscard]] bool flying() const { return flying_; }
  /// True if it has flown while it was watched.
  [[nodiscard]] bool has_flown() const { return has_flown_; }
  void set_offset(std::int64_t offset_ns) { offset_ns_ = offset_ns; }
  /// Time of the run at a time of the clock, clamped to what is recorded.
  [[nodiscard]] std::int64_t run_t_ns(std::int64_t clock_t_ns) const;

  /// Sends the messages that are due: `run`, `series`, `rows`, `estimators` and `metrics`. Rows
  /// wait while the connection has much unsent data; none is lost, because the run keeps them.
  void send_due(ViewerPort* port, std::int64_t now_ns);
  /// The run in the message `playback`.
  [[nodiscard]] nlohmann::json instant(std::int64_t clock_t_ns) const;
  /// Sets the alignment of the estimates. Errors: as server::check_alignment.
  Status align(const std::string& mode);
  [[nodiscard]] const std::string& alignment() const { return places_.mode; }
  /// True while rows wait because of unsent data.
  [[nodiscard]] bool behind() const { return behind_; }

 private:
  void send_run(ViewerPort* port, std::int64_t now_ns);
  void send_series(ViewerPort* port);
  void send_rows(ViewerPort* port, std::int64_t now_ns);
  void send_estimators(ViewerPort* port, std::int64_t now_ns);
  void send_metrics(ViewerPort* port);

  std::string run_id_;
  std::shared_ptr<const server::RunTimeline> timeline_;
  server::Audience::Seat seat_;
  RowFeed feed_;
  EstimatePlaces places_;
  std::int64_t offset_ns_;
  std::int64_t end_ns_ = 0;  ///< of the run
  bool flying_ = false;
  bool has_flown_ = false;
  std::optional<std::uint64_t> revision_;       ///< last revision taken in
  std::optional<std::uint64_t> rows_revision_;  ///< revision of the rows sent last
  std::optional<std::uint64_t> run_revision_;
  std::optional<std::uint64_t> estimators_revision_;
  std::optional<std::uint64_t> metrics_revision_;
  std::optional<std::int64_t> rows_at_ns_;  ///< when they were sent last
  std::optional<std::int64_t> run_at_ns_;
  std::optional<std::int64_t> estimators_at_ns_;
  server::RunStatus status_sent_ = server::RunStatus::kQueued;
  std::string run_sent_;
  std::string series_sent_;
  std::string estimators_sent_;
  std::string metrics_sent_;
  bool behind_ = false;
};

}  // namespace overfly::net
