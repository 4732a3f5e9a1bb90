#include "flight/live/vehicle_reports.hpp"

#include <string>
#include <utility>

#include "core/time.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::live {
namespace {

constexpr std::int64_t kPeriodNs = kNsPerS / 2;
/// Reports that wait to be taken: of 2.7 hours.
constexpr std::size_t kMaxWaiting = 20'000;

}  // namespace

void VehicleReports::add(const mavlink::Vehicle& vehicle, std::int64_t now_ns) {
  if (now_ns < next_ns_) return;
  next_ns_ = now_ns + kPeriodNs;
  const mavlink::VehicleState state = vehicle.state();
  VehicleStatus report;
  report.t_ns = now_ns;
  report.vehicle = std::to_string(state.system) + "." + std::to_string(state.component);
  if (const auto mode = logs::flight_event_of(logs::EventKind::kMode, state.mode)) {
    report.mode = mode->text;
  }
  if (state.heartbeat) report.armed = state.armed();
  report.battery_v = state.battery_v;
  report.battery_percent = state.battery_percent;
  if (state.gps) {
    report.gps_fix = state.gps->fix_type;
    // 255 stands for unknown.
    if (state.gps->satellites != 255) report.satellites = state.gps->satellites;
  }
  // The first report has nothing to count from.
  if (counted_ns_ > 0 && now_ns > counted_ns_) {
    report.messages_per_s =
        static_cast<double>(state.messages - counted_messages_) / s_from_ns(now_ns - counted_ns_);
  }
  counted_ns_ = now_ns;
  counted_messages_ = state.messages;
  report.lost_messages = state.lost_messages;
  const auto sent = static_cast<double>(state.messages + state.lost_messages);
  if (sent > 0.0) report.lost_percent = 100.0 * static_cast<double>(state.lost_messages) / sent;
  if (const auto clock = vehicle.clock()) {
    report.clock_rate = clock->rate;
    report.round_trip_ms = static_cast<double>(clock->round_trip_ns) * 1e-6;
  }
  waiting_.push_back(std::move(report));
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
}

std::optional<VehicleStatus> VehicleReports::take_until(std::int64_t t_ns) {
  std::optional<VehicleStatus> latest;
  while (!waiting_.empty() && waiting_.front().t_ns <= t_ns) {
    latest = std::move(waiting_.front());
    waiting_.pop_front();
  }
  return latest;
}

}  // namespace overfly::flight::live
