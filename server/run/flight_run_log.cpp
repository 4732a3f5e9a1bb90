// FlightRun: what it logs, and the agreement of rendered images with recorded ones.
#include <algorithm>
#include <iterator>
#include <utility>

#include "server/run/flight_run.hpp"

namespace overfly::server {
namespace {

/// Later than any flight; sums with times since 1970 stay in range.
constexpr std::int64_t kFlightsEndNs = 366LL * 86400 * kNsPerS;

}  // namespace

Status FlightRun::judge_recorded_image(const Pending& frame) {
  constexpr int kMostProblemsLogged = 100;
  const CameraSpec* const camera = scenario_.recorded_camera();
  if (camera == nullptr) return {};
  const MadeFrame& made = frame.made;
  const auto index = static_cast<std::size_t>(camera - scenario_.cameras.data());
  const CameraShot& real = made.shots[index];
  if (!real.problem.empty() && problems_logged_++ < kMostProblemsLogged) {
    const std::string end = problems_logged_ == kMostProblemsLogged ? "; no more are listed" : "";
    Status logged = recorder_.log(made.t_ns, "warning", "image lost: " + real.problem + end);
    if (!logged) return logged;
  }
  if (!camera->images->compare_with) return {};
  AgreementRow row{made.frame, made.t_ns, std::nullopt, real.problem};
  if (real.delivered) {
    const Image rendered = grey_of(*frame.images[*camera->images->compare_with]);
    auto agreement = stages_.measure("compare_images", [&] {
      return evaluation::compare_images(*frame.images[index], rendered);
    });
    if (!agreement) return agreement.error();
    row.agreement = *agreement;
  }
  return recorder_.add_agreement(row);
}

Status FlightRun::log_faults(std::int64_t t_ns) {
  for (const FaultNews::Line& line : fault_news_.at(t_ns)) {
    const char* level = line.begins ? "warning" : "info";
    if (Status status = recorder_.log(t_ns, level, line.text, "fault"); !status) return status;
  }
  return {};
}

Status FlightRun::log_flight(const std::vector<FlightEvent>& events,
                             std::optional<VehicleStatus> vehicle,
                             std::int64_t latest_ns) {
  for (const FlightEvent& event : events) {
    const char* kind = to_string(event.kind);
    Status status = recorder_.log(std::min(event.t_ns, latest_ns), "info", event.text, kind);
    if (!status) return status;
  }
  if (!vehicle) return {};
  vehicle->t_ns = std::min(vehicle->t_ns, latest_ns);
  return recorder_.add_vehicle_status(*vehicle);
}

Status FlightRun::log_flight(std::int64_t until_ns, std::int64_t latest_ns) {
  const std::vector<FlightEvent> events = maker_->take_flight_events(until_ns);
  return log_flight(events, maker_->take_vehicle_status(until_ns), latest_ns);
}

Status FlightRun::log_end_of_flight() { return log_flight(kFlightsEndNs, end_ns()); }

Status FlightRun::record_events(std::int64_t frame) {
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    std::vector<std::string> lines;
    for (EstimatorEvent& event : workers_[i]->take_events(frame)) {
      std::move(event.log.begin(), event.log.end(), std::back_inserter(lines));
      if (Status status = recorder_.add_event(i, std::move(event)); !status) return status;
    }
    const std::vector<std::string> others = workers_[i]->take_log();
    lines.insert(lines.end(), others.begin(), others.end());
    if (Status logged = recorder_.add_estimator_log(i, end_ns(), lines); !logged) return logged;
  }
  return {};
}

}  // namespace overfly::server
