#include "server/scenario/document/scenario_faults.hpp"

#include <cmath>
#include <set>
#include <string>

#include "core/time.hpp"
#include "server/scenario/document/scenario_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

std::set<std::string> fields_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kDroppedFrames:
      return {"every", "probability"};
    case FaultKind::kSaturationBurst:
      return {"strength", "radius_px"};
    case FaultKind::kDirt:
    case FaultKind::kWaterDrop:
      return {"strength", "radius_px", "count"};
    case FaultKind::kBlackout:
      return {"strength"};
    case FaultKind::kStampJitter:
      return {"sigma_ms"};
    case FaultKind::kStampOffset:
      return {"offset_ms"};
    case FaultKind::kFrozenFrame:
    case FaultKind::kGpsOutage:
      break;
  }
  return {};
}

/// Rejects fields that do not apply to this kind of fault, and requires those without which it
/// would have no effect.
Status check_fields(const Json& entry, FaultKind kind, const std::string& path) {
  std::set<std::string> common = {"kind", "at_s", "duration_s"};
  if (kind != FaultKind::kGpsOutage) common.insert("camera");
  const std::set<std::string> own = fields_of(kind);
  for (const auto& [field, value] : entry.items()) {
    if (common.count(field) + own.count(field) > 0) continue;
    return bad_field(path + "." + field, value, std::string("not be given for ") + to_string(kind));
  }
  if (entry.contains("every") && entry.contains("probability")) {
    return bad_field(
        path + ".every", entry.at("every"), "not be given with " + path + ".probability");
  }
  for (const char* field : {"sigma_ms", "offset_ms"}) {
    if (own.count(field) == 0 || entry.contains(field)) continue;
    return Error{ErrorCode::kInvalidArgument,
                 path + "." + field + ": must be given for " + to_string(kind)};
  }
  return {};
}

/// One seed per fault, so that adding a fault does not change the others.
std::uint64_t fault_seed(std::uint64_t scenario_seed, std::size_t index) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  return scenario_seed + kGolden * (index + 1);
}

Status read_image_fault(const Json& entry, const std::string& path, FaultSpec& fault) {
  sensor::ImageFault& image = fault.image;
  const std::string kind = entry.at("kind").get<std::string>();
  image.kind = sensor::image_fault_kind_from(kind == "saturation_burst" ? "saturation" : kind)
                   .value_or(sensor::ImageFaultKind::kBlackout);
  image.strength = entry.value("strength", image.strength);
  image.radius_px = entry.value("radius_px", image.radius_px);
  image.count = entry.value("count", image.count);
  image.seed = fault.seed;
  if (Status valid = image.validate(); !valid) return valid.error().in(path);
  return {};
}

Status add_fault(const Json& entry, std::size_t index, Scenario& scenario) {
  const std::string path = "faults." + std::to_string(index);
  FaultSpec fault;
  fault.kind = fault_kind_from(entry.at("kind").get<std::string>()).value_or(fault.kind);
  if (Status status = check_fields(entry, fault.kind, path); !status) return status;
  if (fault.kind == FaultKind::kGpsOutage && !scenario.sensors.gps) {
    return bad_field(path + ".kind", entry.at("kind"), "go with sensors.gps");
  }
  fault.at_ns = ns_from_s(entry.at("at_s").get<double>());
  if (entry.contains("duration_s")) {
    fault.end_ns = fault.at_ns + ns_from_s(entry.at("duration_s").get<double>());
  }
  if (entry.contains("camera")) {
    const auto camera = camera_index(scenario, entry.at("camera"), path + ".camera");
    if (!camera) return camera.error();
    fault.camera = *camera;
  }
  fault.every = entry.value("every", fault.every);
  if (entry.contains("probability")) fault.probability = entry.at("probability").get<double>();
  constexpr double kNsPerMs = 1e6;
  fault.sigma_ns = kNsPerMs * entry.value("sigma_ms", 0.0);
  fault.offset_ns = std::llround(kNsPerMs * entry.value("offset_ms", 0.0));
  fault.seed = fault_seed(scenario.seed, index);
  if (fault.on_lens()) {
    if (Status status = read_image_fault(entry, path, fault); !status) return status;
  }
  scenario.faults.push_back(fault);
  return {};
}

}  // namespace

Result<std::size_t> camera_index(const Scenario& scenario,
                                 const Json& name,
                                 const std::string& path) {
  std::string names;
  for (std::size_t i = 0; i < scenario.cameras.size(); ++i) {
    if (name == scenario.cameras[i].name) return i;
    names += (i == 0 ? "" : ", ") + scenario.cameras[i].name;
  }
  return bad_field(path, name, "be the name of a camera (" + names + ")");
}

Status read_faults(const Json& document, Scenario& scenario) {
  const Json& faults = document.at("faults");
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (Status status = add_fault(faults[i], i, scenario); !status) return status;
  }
  return {};
}

}  // namespace overfly::server
