#include "flight/replay/flight_events.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "core/motion/wrapped_truth.hpp"

namespace overfly::flight {
namespace {

using logs::EventKind;
using logs::LogEvent;

class FlightWithRecords final : public WrappedTruth {
 public:
  FlightWithRecords(std::unique_ptr<TruthSource> flight,
                    std::vector<FlightEvent> events,
                    std::unique_ptr<SampleSource> sensors)
      : WrappedTruth(std::move(flight)), events_(std::move(events)), sensors_(std::move(sensors)) {}

  [[nodiscard]] SampleSource* sample_source() override {
    return sensors_ ? sensors_.get() : flight().sample_source();
  }
  [[nodiscard]] std::vector<FlightEvent> take_events(std::int64_t t_ns) override {
    std::vector<FlightEvent> taken;
    while (next_ < events_.size() && events_[next_].t_ns <= t_ns) taken.push_back(events_[next_++]);
    return taken;
  }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    return flight().state_at(t_ns, cancel);
  }

  std::vector<FlightEvent> events_;
  std::unique_ptr<SampleSource> sensors_;
  std::size_t next_ = 0;
};

std::optional<FlightEvent> flight_event(const LogEvent& event) {
  return logs::flight_event_of(event.kind, event.text);
}

}  // namespace

std::vector<FlightEvent> events_of(const logs::OpenedLog& log,
                                   const std::string& source,
                                   std::uint32_t boot,
                                   std::int64_t begin_ns,
                                   std::int64_t end_ns) {
  const auto stream = std::find_if(log.streams.begin(), log.streams.end(), [&](const auto& info) {
    return info.description.name == source;
  });
  const std::string vehicle = stream != log.streams.end() ? stream->description.vehicle : "";
  std::vector<FlightEvent> events;
  std::map<FlightEventKind, FlightEvent> in_force;
  std::map<std::int64_t, int> items_at;
  std::vector<const LogEvent*> own;
  for (const auto* list : {&log.events_before, &log.events}) {
    for (const LogEvent& event : *list) {
      if (!event.time || event.vehicle != vehicle || event.time->boot != boot) continue;
      own.push_back(&event);
      const auto kept = flight_event(event);
      if (kept && kept->kind == FlightEventKind::kMissionItem) ++items_at[event.time->t_ns];
    }
  }
  std::size_t others = 0;
  for (const LogEvent* event : own) {
    std::optional<FlightEvent> kept = flight_event(*event);
    if (!kept || event->time->t_ns > end_ns) continue;
    const bool item = kept->kind == FlightEventKind::kMissionItem;
    if (item && items_at[event->time->t_ns] > 1) continue;
    kept->t_ns = event->time->t_ns - begin_ns;
    if (kept->t_ns >= 0) {
      if (kept->kind == FlightEventKind::kOther && ++others > kMaxOtherEvents) continue;
      events.push_back(std::move(*kept));
    } else if (kept->kind != FlightEventKind::kOther) {
      kept->t_ns = 0;
      in_force[kept->kind] = std::move(*kept);
    }
  }
  for (auto& [kind, event] : in_force) events.push_back(std::move(event));
  std::stable_sort(events.begin(), events.end(), [](const FlightEvent& a, const FlightEvent& b) {
    return a.t_ns < b.t_ns;
  });
  return events;
}

std::unique_ptr<TruthSource> with_records(std::unique_ptr<TruthSource> flight,
                                          std::vector<FlightEvent> events,
                                          std::unique_ptr<SampleSource> sensors) {
  return std::make_unique<FlightWithRecords>(
      std::move(flight), std::move(events), std::move(sensors));
}

}  // namespace overfly::flight
