#include "server/net/stream/run_watch.hpp"

#include <algorithm>
#include <utility>

#include "server/net/http/json_text.hpp"
#include "server/net/stream/row_encoder.hpp"
#include "server/net/stream/series_list.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::RunStatus;

// Rates of docs/PROTOCOL.md.
constexpr std::int64_t kRowsPeriodNs = 100'000'000;
constexpr std::int64_t kRunPeriodNs = 500'000'000;

bool is_running(RunStatus status) {
  return status == RunStatus::kRunning || status == RunStatus::kQueued;
}

bool is_due(const std::optional<std::int64_t>& last_ns, std::int64_t now_ns, std::int64_t period) {
  return !last_ns || now_ns - *last_ns >= period;
}

}  // namespace

RunWatch::RunWatch(std::string run_id,
                   std::shared_ptr<const server::RunTimeline> timeline,
                   std::int64_t offset_ns,
                   const std::map<std::string, std::size_t>& resume)
    : run_id_(std::move(run_id)),
      timeline_(std::move(timeline)),
      seat_(timeline_->audience()),
      feed_(run_id_, timeline_, resume),
      places_(EstimatePlaces::of(*timeline_, server::kRecordedAlignment)),
      offset_ns_(offset_ns) {
  refresh();
}

Status RunWatch::align(const std::string& mode) {
  if (Status status = server::check_alignment(*timeline_, mode); !status) return status;
  places_ = EstimatePlaces::of(*timeline_, mode);
  return {};
}

bool RunWatch::refresh() {
  const std::uint64_t revision = timeline_->revision();
  if (revision_ == revision) return false;
  revision_ = revision;
  end_ns_ = end_of(*timeline_);
  flying_ = is_running(timeline_->info().status);
  has_flown_ = has_flown_ || flying_;
  return true;
}

std::int64_t RunWatch::run_t_ns(std::int64_t clock_t_ns) const {
  return std::clamp<std::int64_t>(clock_t_ns - offset_ns_, 0, end_ns_);
}

json RunWatch::instant(std::int64_t clock_t_ns) const {
  json instant = instant_json(*timeline_, run_t_ns(clock_t_ns), places_);
  instant["offset_ns"] = offset_ns_;
  instant["end_ns"] = end_ns_;
  return instant;
}

void RunWatch::send_due(ViewerPort* port, std::int64_t now_ns) {
  send_run(port, now_ns);
  send_rows(port, now_ns);
  send_estimators(port, now_ns);
  send_metrics(port);
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

void RunWatch::send_series(ViewerPort* port) {
  std::string text =
      to_text({{"type", "series"}, {"run", run_id_}, {"series", series_json(*timeline_)}});
  if (text == series_sent_) return;
  series_sent_ = text;
  port->send_text(std::move(text));
}

void RunWatch::send_rows(ViewerPort* port, std::int64_t now_ns) {
  const std::uint64_t revision = timeline_->revision();
  if (rows_revision_ == revision) return;
  if (!behind_ && !is_due(rows_at_ns_, now_ns, kRowsPeriodNs)) return;
  rows_at_ns_ = now_ns;
  behind_ = true;
  send_series(port);
  while (port->unsent_bytes() < kHighWaterBytes) {
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
  std::string text = to_text({{"type", "estimators"},
                              {"run", run_id_},
                              {"estimators", estimator_statuses_json(*timeline_)}});
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
  std::string text =
      to_text({{"type", "metrics"}, {"run", run_id_}, {"metrics", server::json_from(*metrics)}});
  if (text == metrics_sent_) return;
  metrics_sent_ = text;
  port->send_text(std::move(text));
}

}  // namespace overfly::net
