#include "server/scenario/document/estimators/estimator_reach.hpp"

#include <algorithm>
#include <string>

#include "vo_bridges/lcm/lcm_options.hpp"

namespace overfly::server {
namespace {

using Trusted = std::vector<Scenario>;

template <typename Condition>
bool any_estimator(const Trusted& trusted, const Condition& condition) {
  return std::any_of(trusted.begin(), trusted.end(), [&](const Scenario& scenario) {
    return std::any_of(scenario.estimators.begin(), scenario.estimators.end(), condition);
  });
}

/// True if the field has its default value, or the value of some trusted estimator.
template <typename Field>
bool is_trusted(const EstimatorSpec& spec, const Trusted& trusted, const Field& field) {
  if (field(spec) == field(EstimatorSpec())) return true;
  return any_estimator(trusted,
                       [&](const EstimatorSpec& known) { return field(spec) == field(known); });
}

/// As a document with any field of `lcm` has it, in which the default is filled in.
std::string lcm_url_of(const EstimatorSpec& spec) {
  return spec.lcm_url.empty() ? LcmEstimatorOptions().url : spec.lcm_url;
}

/// Text with a slash may name a file that the estimator then reads, such as a vocabulary or a
/// calibration.
const std::string* untrusted_parameter(const EstimatorSpec& spec, const Trusted& trusted) {
  for (const auto& [name, value] : spec.parameters) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr || text->find('/') == std::string::npos) continue;
    const bool known = any_estimator(trusted, [&, key = name](const EstimatorSpec& other) {
      const auto same = other.parameters.find(key);
      return same != other.parameters.end() && same->second == ParameterValue(*text);
    });
    if (!known) return &name;
  }
  return nullptr;
}

Error out_of_reach(std::size_t estimator, const std::string& field) {
  return {ErrorCode::kForbidden,
          "estimators." + std::to_string(estimator) + "." + field +
              ": must be as in the scenario's file; clients may set it only if the server was "
              "started with --allow-commands"};
}

}  // namespace

Status check_link(const Scenario& scenario, const std::vector<std::string>& allowed) {
  const auto* live = std::get_if<flight::live::LiveFlight>(&scenario.flight);
  if (live == nullptr) return {};
  const std::string link = live->link.text();
  if (std::find(allowed.begin(), allowed.end(), link) != allowed.end()) return {};
  return Error{
      ErrorCode::kInvalidArgument,
      "flight.mavlink.link = " + link + ": the server was not started with --allow-link " + link};
}

Status check_reach(const Scenario& scenario, const Trusted& trusted) {
  for (const char* const kind : {"mavlink", "ros"}) {
    const auto live_of = [kind](const Scenario& each) {
      const auto flight = each.resolved.find("flight");
      return flight != each.resolved.end() ? flight->value(kind, nlohmann::json())
                                           : nlohmann::json();
    };
    const nlohmann::json wanted = live_of(scenario);
    const bool known = std::any_of(trusted.begin(), trusted.end(), [&](const Scenario& each) {
      return live_of(each) == wanted;
    });
    if (!wanted.is_null() && !known) {
      return Error{ErrorCode::kForbidden,
                   std::string("flight.") + kind +
                       ": must be as in the scenario's file; clients may set it only if the server "
                       "was started with --allow-commands"};
    }
  }
  for (std::size_t i = 0; i < scenario.estimators.size(); ++i) {
    const EstimatorSpec& spec = scenario.estimators[i];
    const char* field = nullptr;
    if (!is_trusted(spec, trusted, [](const auto& s) { return s.command; })) field = "command";
    if (!is_trusted(spec, trusted, [](const auto& s) { return s.listen; })) field = "listen";
    if (!is_trusted(spec, trusted, lcm_url_of)) field = "lcm.url";
    if (!is_trusted(spec, trusted, [](const auto& s) { return s.ros1.master_uri; })) {
      field = "ros1.master_uri";
    }
    if (field != nullptr) return out_of_reach(i, field);
    if (const std::string* parameter = untrusted_parameter(spec, trusted)) {
      return out_of_reach(i, "parameters." + *parameter);
    }
  }
  return {};
}

}  // namespace overfly::server
