#include "server/experiments/explain/fault_places.hpp"

namespace overfly::server::experiments {
namespace {

constexpr double kLatest_s = 86400.0;  // of a scenario's fault, and the longest flight

}  // namespace

bool is_in_flight(const nlohmann::json& document, const nlohmann::json& fault) {
  return fault.at("at_s").get<double>() < document.value("duration_s", kLatest_s);
}

void move_out_of_flight(nlohmann::json& fault) { fault["at_s"] = kLatest_s; }

void remove_last_out_of_flight(const nlohmann::json& document, nlohmann::json& faults) {
  while (!faults.empty() && !is_in_flight(document, faults.back())) faults.erase(faults.size() - 1);
}

}  // namespace overfly::server::experiments
