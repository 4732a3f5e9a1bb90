#include "server/experiments/explain/explanation_json.hpp"

#include <optional>
#include <string>
#include <vector>

#include "server/experiments/explain/explanation_words.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

Json names_of(const std::vector<Cause>& causes) {
  Json names = Json::array();
  for (const Cause cause : causes) names.push_back(to_string(cause));
  return names;
}

template <typename Value>
Json optional_json(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json flight_json(const Reflight& flight, const std::filesystem::path& folder) {
  Json changes = Json::array();
  for (const CauseChange& each : flight.changes) {
    changes.push_back({{"cause", to_string(each.cause)}, {"share", each.share}});
  }
  Json made = {{"name", flight.name},
               {"changes", changes},
               {"seed", flight.seed},
               {"from_s", flight.part.from_s},
               {"to_s", flight.part.to_s},
               {"run", flight.folder.lexically_relative(folder).string()},
               {"survived", nullptr},
               {"outcome", nullptr},
               {"outcome_time_s", nullptr},
               {"initialised_at_s", nullptr},
               {"coverage", nullptr},
               {"texels_per_pixel_median", flight.texels_per_pixel_median},
               {"error", flight.error.empty() ? Json(nullptr) : Json(flight.error)}};
  if (flight.error.empty()) {
    made["survived"] = flight.survived;
    made["outcome"] = evaluation::to_string(flight.score.outcome);
    made["outcome_time_s"] = optional_json(flight.score.outcome_time_s);
    made["initialised_at_s"] = optional_json(flight.score.initialised_at_s);
    made["coverage"] = flight.score.coverage;
  }
  return made;
}

}  // namespace

Json json_from(const Explanation& explanation, const std::filesystem::path& folder) {
  Json flights = Json::array();
  for (const Reflight& flight : explanation.flights) flights.push_back(flight_json(flight, folder));
  Json untried = Json::array();
  for (const UntriedCause& each : explanation.untried) {
    untried.push_back({{"cause", to_string(each.cause)}, {"reason", each.reason}});
  }
  Json margin = nullptr;
  if (explanation.margin) {
    margin = {{"cause", to_string(explanation.margin->cause)},
              {"survives_share", explanation.margin->survives_share},
              {"fails_share", explanation.margin->fails_share}};
  }
  return {{"run", explanation.run},
          {"estimator", explanation.estimator},
          {"outcome", evaluation::to_string(explanation.score.outcome)},
          {"outcome_time_s", optional_json(explanation.score.outcome_time_s)},
          {"reproduced", explanation.reproduced},
          {"reproduced_with_other_seed", optional_json(explanation.reproduced_with_other_seed)},
          {"from_s", explanation.part.from_s},
          {"to_s", explanation.part.to_s},
          {"sufficient", names_of(explanation.sufficient)},
          {"sufficiency_tested", names_of(explanation.sufficiency_tested)},
          {"necessary", names_of(explanation.necessary)},
          {"not_changed", names_of(explanation.not_changed)},
          {"together", names_of(explanation.together)},
          {"confirmed", names_of(explanation.confirmed)},
          {"withdrawn", names_of(explanation.withdrawn)},
          {"pair", names_of(explanation.pair)},
          {"margin", margin},
          {"data_limited", explanation.data_limited},
          {"data_reason", explanation.data_reason},
          {"sentences", sentences_of(explanation)},
          {"flights", flights},
          {"untried", untried}};
}

}  // namespace overfly::server::experiments
