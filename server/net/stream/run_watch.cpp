#include "server/net/stream/run_watch.hpp"

#include <utility>

#include "server/net/http/json_text.hpp"
#include "server/net/stream/row_encoder.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::net {
namespace {

using server::RunStatus;

// Rates of docs/PROTOCOL.md.
constexpr std::int64_t kRowsPeriodNs = 100'000'000;
constexpr std::int64_t kRunPeriodNs = 500'000'000;
constexpr std::int64_t kPlaybackPeriodNs = 50'000'000;
constexpr std::int64_t kExtentPeriodNs = 500'000'000;
/// No rows are encoded while more than this is unsent.
constexpr std::size_t kRowsHighWaterBytes = std::size_t{1} << 20U;

bool is_running(RunStatus status) {
  return status == RunStatus::kRunning || status == RunStatus::kQueued;
}

bool is_due(const std::optional<std::int64_t>& last_ns, std::int64_t now_ns, std::int64_t period) {
  return !last_ns || now_ns - *last_ns >= period;
}

}  // namespace

RunWatch::RunWatch(std::shared_ptr<const server::RunTimeline> timeline,
                   const std::map<std::string, std::size_t>& resume)
    : timeline_(std::move(timeline)),
      seat_(timeline_->audience()),
      feed_(timeline_, resume),
      cursor_(is_running(timeline_->info().status)),
      places_(EstimatePlaces::of(*timeline_, server::kRecordedAlignment)) {}

Status RunWatch::align(const std::string& mode) {
  if (Status status = server::check_alignment(*timeline_, mode); !status) return status;
  places_ = EstimatePlaces::of(*timeline_, mode);
  playback_due_ = true;
  return {};
}

void RunWatch::refresh(std::int64_t now_ns) {
  const std::uint64_t revision = timeline_->revision();
  if (revision_ != revision) {
    revision_ = revision;
    cursor_.set_extent(end_of(*timeline_), is_running(timeline_->info().status));
  }
  cursor_.advance(now_ns);
}

void RunWatch::send_due(ViewerPort* port, std::int64_t now_ns) {
  send_run(port, now_ns);
  send_rows(port, now_ns);
  send_estimators(port, now_ns);
  send_metrics(port);
  send_playback(port, now_ns);
}

void RunWatch::send_run(ViewerPort* port, std::int64_t now_ns) {
  const std::uint64_t revision = timeline_->revision();
  if (run_revision_ == revision) return;
  const server::RunInfo info = timeline_->info();
  if (info.status == status_sent_ && !is_due(run_at_ns_, now_ns, kRunPeriodNs)) return;
  run_revision_ = revision;
  std::string text = to_text({{"type", "run"}, {"run", run_json(info)}});
  if (text == run_sent_) return;
  run_at_ns_ = now_ns;
  status_sent_ = info.status;
  run_sent_ = text;
  port->send_text(std::move(text));
}

void RunWatch::send_rows(ViewerPort* port, std::int64_t now_ns) {
  const std::uint64_t revision = timeline_->revision();
  if (rows_revision_ == revision) return;
  if (!behind_ && !is_due(rows_at_ns_, now_ns, kRowsPeriodNs)) return;
  rows_at_ns_ = now_ns;
  behind_ = true;
  while (port->unsent_bytes() < kRowsHighWaterBytes) {
    auto message = feed_.next();
    if (!message) {
      rows_revision_ = revision;
      behind_ = false;
      return;
    }
    port->send_text(std::move(*message));
  }
}

void RunWatch::send_estimators(ViewerPort* port, std::int64_t now_ns) {
  const std::uint64_t revision = timeline_->revision();
  if (estimators_revision_ == revision || timeline_->estimators().empty()) return;
  if (!is_due(estimators_at_ns_, now_ns, kRunPeriodNs)) return;
  estimators_revision_ = revision;
  std::string text =
      to_text({{"type", "estimators"}, {"estimators", estimator_statuses_json(*timeline_)}});
  if (text == estimators_sent_) return;
  estimators_at_ns_ = now_ns;
  estimators_sent_ = text;
  port->send_text(std::move(text));
}

void RunWatch::send_metrics(ViewerPort* port) {
  const std::uint64_t revision = timeline_->revision();
  if (metrics_revision_ == revision) return;
  metrics_revision_ = revision;
  const auto metrics = timeline_->metrics();
  if (!metrics) return;
  std::string text = to_text({{"type", "metrics"}, {"metrics", server::json_from(*metrics)}});
  if (text == metrics_sent_) return;
  metrics_sent_ = text;
  port->send_text(std::move(text));
}

void RunWatch::send_playback(ViewerPort* port, std::int64_t now_ns) {
  const SentCursor now{
      cursor_.t_ns(), cursor_.playing(), cursor_.live(), cursor_.loop(), cursor_.speed()};
  const bool moved = now != cursor_sent_ && is_due(playback_at_ns_, now_ns, kPlaybackPeriodNs);
  const bool grew =
      cursor_.end_ns() != end_sent_ns_ && is_due(playback_at_ns_, now_ns, kExtentPeriodNs);
  if (!playback_due_ && !moved && !grew) return;
  // Skipped on a slow connection, because the next message contains the position too.
  if (!playback_due_ && port->unsent_bytes() > kRowsHighWaterBytes) return;
  playback_due_ = false;
  cursor_sent_ = now;
  end_sent_ns_ = cursor_.end_ns();
  playback_at_ns_ = now_ns;
  port->send_text(to_text(playback_json(*timeline_, cursor_, places_)));
}

}  // namespace overfly::net
