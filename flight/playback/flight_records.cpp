#include "flight/playback/flight_records.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/vehicle/vehicle_report.hpp"

namespace overfly::flight::playback {
namespace {

using mavlink::MessageId;

constexpr std::int64_t kNsPerMilli = 1'000'000;

/// SIM_STATE has no time: it gets that of the message before it.
constexpr MessageId kOfEachInstant[] = {MessageId::kAttitude,
                                        MessageId::kAttitudeQuaternion,
                                        MessageId::kSimState,
                                        MessageId::kGlobalPositionInt};
constexpr MessageId kOfEachSecond[] = {MessageId::kHeartbeat, MessageId::kSystemTime};

vehicle::VehicleReport report_of(const AircraftState& state, const LocalFrame& frame) {
  vehicle::VehicleReport report;
  report.mode = vehicle::Mode::kAuto;
  report.armed = true;
  report.in_air = true;
  report.frame = frame;
  const Eigen::Vector3d& position = state.T_world_body.translation;
  // Relative to the horizon where the aircraft is.
  const Eigen::Quaterniond R_enu_world =
      frame.R_world_enu_at(frame.geodetic_from_world(position)).conjugate();
  report.state.position_world_m = position;
  report.state.v_world_m_s = R_enu_world * state.v_body_world_m_s;
  report.state.attitude = attitude_from(R_enu_world * state.T_world_body.rotation);
  report.state.omega_body_rad_s = state.omega_body_rad_s;
  report.state.specific_force_body_m_s2.setConstant(std::numeric_limits<double>::quiet_NaN());
  return report;
}

}  // namespace

Result<FlightRecords> FlightRecords::create(PlayedFlight played) {
  if (Status status = check_message_rate(played.rate_hz); !status) return status.error();
  const std::optional<std::int64_t> length_ns = played.flight->duration_ns();
  if (!length_ns) {
    return Error{ErrorCode::kUnsupported,
                 played.flight->description() + ": the length of the flight is not known"};
  }
  const std::optional<std::int64_t> log_start_ns = played.flight->log_start_ns();
  FlightRecords records(std::move(played));
  records.period_ms_ = std::max<std::int64_t>(1, std::llround(1e3 / records.played_.rate_hz));
  records.instants_per_s_ = std::max<std::int64_t>(1, 1000 / records.period_ms_);
  constexpr std::int64_t kClockMs = std::numeric_limits<std::uint32_t>::max();
  const std::int64_t start_ns =
      log_start_ns && *log_start_ns >= 0 && *log_start_ns < kClockMs / 2 * kNsPerMilli
          ? *log_start_ns
          : 0;
  records.first_ms_ = (start_ns + kNsPerMilli - 1) / kNsPerMilli;
  records.first_ns_ = records.first_ms_ * kNsPerMilli - start_ns;
  records.instants_ = (*length_ns - records.first_ns_) / (records.period_ms_ * kNsPerMilli) + 1;
  const std::int64_t last_ms = records.first_ms_ + (records.instants_ - 1) * records.period_ms_;
  if (*length_ns < records.first_ns_ || last_ms > kClockMs) {
    return Error{ErrorCode::kUnsupported,
                 records.played_.flight->description() + ": a flight of " +
                     number_text(s_from_ns(*length_ns)) + " s: must be from 1 ms to 49 days long"};
  }
  const auto first = records.played_.flight->state_at(records.first_ns_);
  if (!first) return first.error();
  if (*first) {
    records.home_alt_m_ =
        records.played_.frame.geodetic_from_world((*first)->T_world_body.translation)
            .alt_ellipsoid_m;
  }
  return records;
}

std::uint64_t FlightRecords::count() const {
  const std::int64_t seconds = (instants_ + instants_per_s_ - 1) / instants_per_s_;
  return static_cast<std::uint64_t>(instants_) * std::size(kOfEachInstant) +
         static_cast<std::uint64_t>(seconds) * std::size(kOfEachSecond);
}

Status FlightRecords::seek(std::int64_t t_us) {
  const std::int64_t period_us = period_ms_ * 1000;
  next_instant_ = std::max<std::int64_t>(0, (t_us + period_us - 1) / period_us);
  frames_.clear();
  next_frame_ = 0;
  return {};
}

Status FlightRecords::make(std::int64_t instant) {
  const std::int64_t t_ns = first_ns_ + instant * period_ms_ * kNsPerMilli;
  const auto state = played_.flight->state_at(t_ns);
  if (!state) return state.error();
  frames_.clear();
  next_frame_ = 0;
  if (!*state) return {};
  vehicle::VehicleReport report = report_of(**state, played_.frame);
  report.boot_ns = (first_ms_ + instant * period_ms_) * kNsPerMilli;
  report.height_above_home_m =
      played_.frame.geodetic_from_world((*state)->T_world_body.translation).alt_ellipsoid_m -
      home_alt_m_;
  if (played_.unix_at_start_ns) report.unix_ns = *played_.unix_at_start_ns + t_ns;
  const auto add = [&](std::span<const MessageId> ids) -> Status {
    for (const MessageId id : ids) {
      const auto payload = vehicle::payload_of(id, report);
      if (!payload) continue;
      auto frame = mavlink::encode_frame({mavlink::Version::kTwo,
                                          sequence_++,
                                          1,
                                          1,
                                          static_cast<std::uint32_t>(id),
                                          false,
                                          payload->bytes()});
      if (!frame) return frame.error();
      frames_.push_back(std::move(*frame));
    }
    return {};
  };
  if (instant % instants_per_s_ == 0) {
    if (Status status = add(kOfEachSecond); !status) return status;
  }
  return add(kOfEachInstant);
}

Result<std::optional<PlaybackRecords::Record>> FlightRecords::next() {
  if (next_frame_ == frames_.size()) {
    if (next_instant_ >= instants_) return std::optional<Record>();
    if (Status status = make(next_instant_++); !status) return status.error();
    if (frames_.empty()) return std::optional<Record>();
  }
  return std::optional(Record{time_us(next_instant_ - 1), frames_[next_frame_++]});
}

}  // namespace overfly::flight::playback
