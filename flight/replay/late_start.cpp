#include "flight/replay/late_start.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "core/time.hpp"

namespace overfly::flight {
namespace {

/// "7", "0.25": a division is rounded correctly.
std::string short_seconds_text(std::int64_t t_ns) {
  return number_text(static_cast<double>(t_ns) / static_cast<double>(kNsPerS));
}

class LateStart final : public TruthSource {
 public:
  LateStart(std::unique_ptr<TruthSource> flight, std::int64_t start_ns)
      : flight_(std::move(flight)), start_ns_(start_ns) {}

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override {
    const std::optional<std::int64_t> whole_ns = flight_->duration_ns();
    if (!whole_ns) return std::nullopt;
    return *whole_ns - start_ns_;
  }
  [[nodiscard]] std::string description() const override {
    return flight_->description() + ", from " + short_seconds_text(start_ns_) + " s on";
  }
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override {
    const std::optional<std::int64_t> whole_ns = flight_->log_start_ns();
    if (!whole_ns) return std::nullopt;
    return *whole_ns + start_ns_;
  }
  [[nodiscard]] std::vector<std::string> warnings() const override { return flight_->warnings(); }
  void begin() override { flight_->begin(); }
  [[nodiscard]] std::vector<FlightEvent> take_events(std::int64_t t_ns) override {
    std::vector<FlightEvent> later;
    std::map<FlightEventKind, FlightEvent> in_force;
    for (FlightEvent& event : flight_->take_events(t_ns + start_ns_)) {
      event.t_ns -= start_ns_;
      const bool lasting = event.kind != FlightEventKind::kOther;
      if (event.t_ns > 0 || (event.t_ns == 0 && !lasting)) {
        later.push_back(std::move(event));
      } else if (lasting) {
        event.t_ns = 0;
        in_force[event.kind] = std::move(event);
      }
    }
    std::vector<FlightEvent> events;
    for (auto& [kind, event] : in_force) events.push_back(std::move(event));
    std::move(later.begin(), later.end(), std::back_inserter(events));
    return events;
  }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    auto state = flight_->state_at(t_ns + start_ns_, cancel);
    if (state && *state) (*state)->t_ns -= start_ns_;
    return state;
  }

  std::unique_ptr<TruthSource> flight_;
  std::int64_t start_ns_;
};

}  // namespace

Result<std::unique_ptr<TruthSource>> started_late(std::unique_ptr<TruthSource> flight,
                                                  std::int64_t start_ns) {
  const std::optional<std::int64_t> whole_ns = flight->duration_ns();
  if (whole_ns && *whole_ns <= start_ns) {
    return Error{ErrorCode::kInvalidArgument,
                 "start_s = " + short_seconds_text(start_ns) + ": the flight ends at " +
                     short_seconds_text(*whole_ns) + " s"};
  }
  return std::unique_ptr<TruthSource>(std::make_unique<LateStart>(std::move(flight), start_ns));
}

}  // namespace overfly::flight
