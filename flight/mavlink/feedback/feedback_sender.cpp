#include "flight/mavlink/feedback/feedback_sender.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "core/barrier.hpp"
#include "core/time.hpp"
#include "flight/mavlink/autopilots.hpp"
#include "flight/mavlink/feedback/feedback_message.hpp"

namespace overfly::flight::mavlink {
namespace {

/// Without TIMESYNC the vehicle's clock is known from its messages only: they are looked at this
/// often while an estimate waits.
constexpr std::chrono::nanoseconds kLook{2'000'000};

std::int64_t period_of(double rate_hz) {
  return rate_hz > 0.0 ? std::llround(static_cast<double>(kNsPerS) / rate_hz) : 0;
}

std::int64_t host_utc_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

FeedbackSender::FeedbackSender(std::shared_ptr<Vehicle> vehicle,
                               const FeedbackOptions& options,
                               const LocalFrame& frame,
                               double geoid_separation_m,
                               std::int64_t start_ns)
    : vehicle_(std::move(vehicle)),
      options_(options),
      frame_(frame),
      geoid_separation_m_(geoid_separation_m),
      start_ns_(start_ns),
      queue_(options.latency_ns, period_of(options.rate_hz)),
      thread_([this] {
        contained([this] { run(); },
                  [this](const std::string& what) {
                    const std::lock_guard lock(mutex_);
                    failure_ = what;
                  });
      }) {}

FeedbackSender::~FeedbackSender() { finish(); }

void FeedbackSender::finish() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  news_.notify_all();
  if (!thread_.joinable()) return;
  thread_.join();
  const std::lock_guard lock(mutex_);
  counts_.waiting = queue_.size();
}

void FeedbackSender::start_at(std::int64_t start_ns) {
  const std::lock_guard lock(mutex_);
  start_ns_ = start_ns;
}

void FeedbackSender::take(const PlacedEstimate& estimate) {
  {
    const std::lock_guard lock(mutex_);
    if (stops_) return;
    std::optional<FeedbackSample> sample = track_.take(estimate);
    if (!sample) {
      ++counts_.unplaced;
      return;
    }
    sample->t_ns += start_ns_;
    queue_.add(*sample);
  }
  news_.notify_all();
}

void FeedbackSender::run() {
  std::unique_lock lock(mutex_);
  while (!stops_) {
    if (!queue_.next_due_ns()) {
      news_.wait(lock);
      continue;
    }
    lock.unlock();
    const VehicleState state = vehicle_->state();
    const std::optional<VehicleClock> timesync = vehicle_->clock();
    const std::optional<VehicleNow> now = vehicle_now(timesync, state.boot_ns);
    lock.lock();
    std::vector<FeedbackSample> due;
    if (now) due = queue_.take_due(now->ns);
    lock.unlock();
    for (const FeedbackSample& sample : due) send(sample, *now, state);
    lock.lock();
    const std::optional<std::int64_t> next_ns = queue_.next_due_ns();
    if (!next_ns) continue;
    std::chrono::nanoseconds wait = kLook;
    if (now && now->by_timesync) {
      const double left_s = s_from_ns(*next_ns - now->ns) / std::max(timesync->rate, 1e-3);
      wait = std::chrono::nanoseconds(ns_from_s(std::clamp(left_s, 1e-4, 0.05)));
    }
    news_.wait_for(lock, wait);
  }
}

void FeedbackSender::send(const FeedbackSample& sample,
                          const VehicleNow& now,
                          const VehicleState& state) {
  FeedbackPlace place{frame_, geoid_separation_m_, 3, std::nullopt, std::nullopt, 0.0, 0};
  if (state.heartbeat) place.autopilot = state.heartbeat->autopilot;
  if (state.origin) {
    place.origin = logs::LocalOrigin{
        state.origin->lat_deg,
        state.origin->lon_deg,
        state.origin->alt_msl_m,
        place.autopilot == kPx4 ? logs::LocalGrid::kPx4 : logs::LocalGrid::kArduPilot};
  }
  if (state.position) place.own_alt_msl_m = state.position->alt_msl_m;
  place.own_v_down_m_s = state.v_down_m_s.value_or(0.0);
  const std::int64_t age_ns = now.ns - sample.t_ns;
  place.utc_ns =
      state.utc_minus_boot_ns ? *state.utc_minus_boot_ns + sample.t_ns : host_utc_ns() - age_ns;
  const std::optional<FeedbackPayload> message = feedback_message(options_, sample, place);
  const bool sent = message && vehicle_->send(message->id, message->payload);
  const std::lock_guard lock(mutex_);
  if (!message) {
    ++counts_.unknown;
  } else if (!sent) {
    ++counts_.unsent;
  } else {
    ++counts_.sent;
    counts_.by_timesync += now.by_timesync ? 1 : 0;
    counts_.oldest_sent_ns = std::max(counts_.oldest_sent_ns, age_ns);
  }
}

FeedbackCounts FeedbackSender::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::string FeedbackSender::report() const {
  const VehicleState state = vehicle_->state();
  const std::lock_guard lock(mutex_);
  std::string text = "sent " + std::to_string(counts_.sent) + " " + to_string(options_.message) +
                     " to vehicle " + std::to_string(state.system) + "." +
                     std::to_string(state.component) + ", the oldest " +
                     std::to_string(counts_.oldest_sent_ns / 1'000'000) +
                     " ms after its capture; " + std::to_string(track_.resets()) + " resets";
  const auto add = [&text](std::uint64_t count, const std::string& what) {
    if (count > 0) text += "; " + std::to_string(count) + " " + what;
  };
  add(counts_.unplaced, "answers were not placed in the world");
  add(queue_.too_late(), "estimates were older than 500 ms and were not sent");
  add(queue_.clock_back(), "estimates were not sent because the vehicle's clock was far behind");
  add(counts_.unknown, "were not sent because the vehicle's origin or height was unknown");
  add(counts_.unsent, "were not taken by the link");
  add(counts_.waiting, "were still waiting for their latency at the end");
  add(counts_.sent - counts_.by_timesync,
      "were sent by the times in the vehicle's messages: TIMESYNC was not answered, or differed");
  if (!failure_.empty()) text += "; sending ended early: " + failure_;
  return text;
}

}  // namespace overfly::flight::mavlink
