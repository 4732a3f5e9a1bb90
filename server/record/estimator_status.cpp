#include "server/record/estimator_status.hpp"

#include <array>
#include <utility>

namespace overfly::server {
namespace {

using Json = nlohmann::json;

using Measured = EstimatorUse::Measured;

constexpr std::array<std::pair<Measured, const char*>, 3> kMeasured = {
    {{Measured::kProcess, "process"},
     {Measured::kOwnAccount, "own_account"},
     {Measured::kCallingThread, "calling_thread"}}};

const char* text_of(Measured measured) {
  for (const auto& [value, text] : kMeasured) {
    if (value == measured) return text;
  }
  return "";
}

}  // namespace

std::string state_text(const EstimatorStatus& status) {
  if (!status.crash.empty()) return "CRASHED";
  return status.state ? to_string(*status.state) : "STARTING";
}

Json json_from(const EstimatorUse& use) {
  return {{"cpu_s", use.cpu_s},
          {"cpu_percent", use.cpu_percent},
          {"peak_memory_mb", use.peak_memory_mb ? Json(*use.peak_memory_mb) : Json(nullptr)},
          {"measured", text_of(use.measured)}};
}

std::optional<EstimatorUse> estimator_use_from(const Json& value) {
  if (!value.is_object()) return std::nullopt;
  const auto number = [&](const char* key) -> std::optional<double> {
    const auto found = value.find(key);
    if (found == value.end() || !found->is_number()) return std::nullopt;
    return found->get<double>();
  };
  if (!number("cpu_s") || !number("cpu_percent")) return std::nullopt;
  EstimatorUse use;
  use.cpu_s = *number("cpu_s");
  use.cpu_percent = *number("cpu_percent");
  use.peak_memory_mb = number("peak_memory_mb");
  const auto measured = value.find("measured");
  for (const auto& [known, text] : kMeasured) {
    if (measured != value.end() && *measured == text) use.measured = known;
  }
  return use;
}

Json json_from(const EstimatorStatus& status) {
  Json latency = nullptr;
  if (status.latency) {
    latency = {{"median", status.latency->median_ms},
               {"p95", status.latency->p95_ms},
               {"p99", status.latency->p99_ms},
               {"max", status.latency->max_ms}};
  }
  return {{"state", state_text(status)},
          {"crash", status.crash.empty() ? Json(nullptr) : Json(status.crash)},
          {"answered", status.answered},
          {"dropped", status.dropped},
          {"unanswered", status.unanswered},
          {"hashes_compared", status.hashes_compared},
          {"hash_mismatches", status.hash_mismatches},
          {"latency_ms", std::move(latency)},
          {"resources", status.use ? json_from(*status.use) : Json(nullptr)}};
}

}  // namespace overfly::server
