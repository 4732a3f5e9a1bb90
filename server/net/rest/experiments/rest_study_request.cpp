#include "server/net/rest/experiments/rest_study_request.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "server/experiments/explain/cause.hpp"
#include "server/experiments/studies/study_service.hpp"
#include "server/net/http/json_text.hpp"

namespace overfly::net {
namespace {

namespace experiments = server::experiments;
using experiments::StudyKind;
using experiments::StudyLimits;
using experiments::StudyRequest;
using nlohmann::json;

constexpr std::size_t kLongestPath = 300;
constexpr std::size_t kLongestLabel = 100;
constexpr double kLargest = 1e12;

std::size_t count_in(JsonFields& fields, const char* name, std::size_t most, std::size_t absent) {
  const auto value = fields.integer(name, 1, static_cast<std::int64_t>(most));
  return value ? static_cast<std::size_t>(*value) : absent;
}

experiments::StudyScenario scenario_in(JsonFields& fields, const json& body) {
  experiments::StudyScenario scenario;
  if (body.contains("document")) {
    for (const char* other : {"scenario", "overrides"}) {
      if (body.contains(other)) fields.reject(other, ": must not be given with document");
    }
    if (const json* document = fields.object("document")) scenario.document = *document;
    return scenario;
  }
  fields.require("scenario");
  scenario.name = fields.text("scenario").value_or("");
  if (const json* overrides = fields.object("overrides")) {
    for (const auto& [path, value] : overrides->items()) {
      scenario.overrides.push_back({path, value});
    }
  }
  return scenario;
}

experiments::ExplainRequest explain_in(JsonFields& fields) {
  experiments::ExplainRequest asks;
  fields.require("run");
  asks.run = fields.text("run").value_or("");
  asks.estimator = fields.text("estimator").value_or("");
  asks.flights = count_in(fields, "flights", StudyLimits::kMostExplainFlights, asks.flights);
  const json* causes = fields.array("causes");
  if (causes == nullptr) return asks;
  const std::size_t most = experiments::all_causes().size();
  if (causes->size() > most) {
    fields.reject("causes", ": must have at most " + std::to_string(most) + " entries");
    return asks;
  }
  for (const json& cause : *causes) {
    if (cause.is_string()) {
      asks.causes.push_back(cause.get<std::string>());
    } else {
      fields.reject("causes", ": must be texts");
    }
  }
  return asks;
}

experiments::PredictRequest predict_in(JsonFields& fields, const json& body) {
  experiments::PredictRequest asks;
  asks.scenario = scenario_in(fields, body);
  asks.camera = fields.text("camera").value_or("");
  asks.rate_hz = fields.number("rate_hz", StudyLimits::kLeastRateHz, StudyLimits::kMostRateHz)
                     .value_or(asks.rate_hz);
  asks.map = fields.boolean("map").value_or(asks.map);
  asks.map_km = fields.number("map_km", StudyLimits::kLeastMapKm, StudyLimits::kMostMapKm)
                    .value_or(asks.map_km);
  asks.cell_m = fields.number("cell_m", StudyLimits::kLeastCellM, StudyLimits::kMostCellM)
                    .value_or(asks.cell_m);
  return asks;
}

Result<experiments::HuntAxis> axis_from(const json& entry, const std::string& where) {
  if (!entry.is_object()) {
    return Error{ErrorCode::kInvalidArgument, where + ": must be an object with path, from and to"};
  }
  JsonFields fields(entry, where);
  experiments::HuntAxis axis;
  for (const char* name : {"path", "from", "to"}) fields.require(name);
  axis.path = fields.text("path").value_or("");
  axis.label = fields.text("label").value_or("");
  axis.unit = fields.text("unit").value_or("");
  axis.from = fields.number("from", -kLargest, kLargest).value_or(0.0);
  axis.to = fields.number("to", -kLargest, kLargest).value_or(0.0);
  axis.step = fields.number("step", 1e-9, kLargest);
  if (axis.path.empty() || axis.path.size() > kLongestPath) {
    fields.reject("path", ": must have 1 to " + std::to_string(kLongestPath) + " characters");
  }
  for (const auto& [name, text] :
       {std::pair{"label", &axis.label}, std::pair{"unit", &axis.unit}}) {
    if (text->size() > kLongestLabel) {
      fields.reject(name, ": must have at most " + std::to_string(kLongestLabel) + " characters");
    }
  }
  if (axis.from >= axis.to) fields.reject("to", ": must be greater than from");
  if (const Status status = fields.finish(); !status) return status.error();
  return axis;
}

/// Errors: kInvalidArgument of an axis.
Status read_axes(JsonFields& fields, std::vector<experiments::HuntAxis>& axes) {
  fields.require("axes");
  const json* list = fields.array("axes");
  if (list == nullptr) return {};
  if (list->empty() || list->size() > StudyLimits::kMostHuntAxes) {
    fields.reject("axes",
                  ": must have 1 to " + std::to_string(StudyLimits::kMostHuntAxes) + " entries");
    return {};
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    Result<experiments::HuntAxis> axis = axis_from((*list)[i], "axes." + std::to_string(i));
    if (!axis) return axis.error();
    axes.push_back(std::move(*axis));
  }
  return {};
}

Result<experiments::HuntRequest> hunt_in(JsonFields& fields, const json& body) {
  experiments::HuntRequest asks;
  asks.scenario = scenario_in(fields, body);
  if (Status status = read_axes(fields, asks.axes); !status) return status.error();
  asks.estimator = fields.text("estimator").value_or("");
  asks.flights = count_in(fields, "flights", StudyLimits::kMostHuntFlights, asks.flights);
  asks.repeats = count_in(fields, "repeats", StudyLimits::kMostHuntRepeats, asks.repeats);
  const auto seed = fields.integer("seed", 0, static_cast<std::int64_t>(StudyLimits::kMostSeed));
  asks.seed = seed ? static_cast<std::uint64_t>(*seed) : asks.seed;
  asks.all = fields.boolean("all").value_or(false);
  asks.position_rmse_limit_m = fields.number("position_rmse_limit_m", 1e-6, kLargest);
  if (asks.flights < asks.repeats) {
    fields.reject("flights", ": must be at least repeats = " + std::to_string(asks.repeats));
  }
  return asks;
}

}  // namespace

Result<StudyRequest> parse_study_request(const std::string& text) {
  const Result<json> body = parse_object(text, "the body");
  if (!body) return body.error();
  JsonFields fields(*body, "");
  fields.require("kind");
  const std::string name = fields.text("kind").value_or("");
  const auto kind = experiments::study_kind_from(name);
  if (!kind) {
    fields.reject("kind", " = " + name.substr(0, 100) + ": must be explain, predict or hunt");
    return fields.finish().error();
  }
  StudyRequest request;
  const std::size_t jobs = experiments::StudyService::most_jobs();
  request.jobs = count_in(fields, "jobs", jobs, 0);
  switch (*kind) {
    case StudyKind::kExplain:
      request.asks = explain_in(fields);
      break;
    case StudyKind::kPredict:
      request.asks = predict_in(fields, *body);
      break;
    case StudyKind::kHunt: {
      Result<experiments::HuntRequest> hunt = hunt_in(fields, *body);
      if (!hunt) return hunt.error();
      request.asks = std::move(*hunt);
      break;
    }
  }
  if (const Status status = fields.finish(); !status) return status.error();
  return request;
}

json study_limits_json() {
  const experiments::ExplainRequest explain;
  const experiments::PredictRequest predict;
  const experiments::HuntRequest hunt;
  json causes = json::array();
  for (const experiments::Cause cause : experiments::all_causes()) {
    causes.push_back({{"name", experiments::to_string(cause)},
                      {"words", experiments::words_for(cause)},
                      {"disturbance", experiments::is_disturbance(cause)}});
  }
  const auto range = [](auto least, auto most, auto absent) {
    return json{{"least", least}, {"most", most}, {"default", absent}};
  };
  return {
      {"jobs",
       range(1, experiments::StudyService::most_jobs(), experiments::StudyService::default_jobs())},
      {"explain",
       {{"flights", range(1, StudyLimits::kMostExplainFlights, explain.flights)},
        {"causes", causes}}},
      {"predict",
       {{"rate_hz", range(StudyLimits::kLeastRateHz, StudyLimits::kMostRateHz, predict.rate_hz)},
        {"map_km", range(StudyLimits::kLeastMapKm, StudyLimits::kMostMapKm, predict.map_km)},
        {"cell_m", range(StudyLimits::kLeastCellM, StudyLimits::kMostCellM, predict.cell_m)}}},
      {"hunt",
       {{"flights", range(1, StudyLimits::kMostHuntFlights, hunt.flights)},
        {"repeats", range(1, StudyLimits::kMostHuntRepeats, hunt.repeats)},
        {"axes", range(1, StudyLimits::kMostHuntAxes, 1)},
        {"seed", range(0, StudyLimits::kMostSeed, hunt.seed)}}}};
}

}  // namespace overfly::net
