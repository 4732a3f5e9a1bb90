#include "server/scenario/fault_spec.hpp"

#include <array>
#include <utility>

namespace overfly::server {
namespace {

constexpr std::array<std::pair<FaultKind, const char*>, 9> kNames = {
    {{FaultKind::kDroppedFrames, "dropped_frames"},
     {FaultKind::kFrozenFrame, "frozen_frame"},
     {FaultKind::kSaturationBurst, "saturation_burst"},
     {FaultKind::kDirt, "dirt"},
     {FaultKind::kWaterDrop, "water_drop"},
     {FaultKind::kBlackout, "blackout"},
     {FaultKind::kStampJitter, "stamp_jitter"},
     {FaultKind::kStampOffset, "stamp_offset"},
     {FaultKind::kGpsOutage, "gps_outage"}}};

}  // namespace

const char* to_string(FaultKind kind) {
  for (const auto& [known, name] : kNames) {
    if (known == kind) return name;
  }
  return "fault";
}

std::optional<FaultKind> fault_kind_from(const std::string& text) {
  for (const auto& [kind, name] : kNames) {
    if (text == name) return kind;
  }
  return std::nullopt;
}

bool FaultSpec::on_lens() const {
  return kind == FaultKind::kSaturationBurst || kind == FaultKind::kDirt ||
         kind == FaultKind::kWaterDrop || kind == FaultKind::kBlackout;
}

}  // namespace overfly::server
