#include "server/experiments/hunt/hunt_output.hpp"

#include <cstdio>

#include "core/text/number_text.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

const char* method_name(SearchMethod method) {
  return method == SearchMethod::kRandom ? "random" : "model";
}

std::string plain_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Json json_of_flight(const HuntedFlight& flight) {
  Json factors = Json::object();
  for (const MarginFactor& factor : flight.margin.factors) factors[factor.name] = factor.share;
  return {{"values", flight.cell.values},
          {"repeat", flight.repeat},
          {"seed", flight.seed},
          {"run", flight.run},
          {"outcome", evaluation::to_string(flight.outcome)},
          {"margin", flight.margin.value},
          {"failed", flight.margin.failed},
          {"failure", flight.margin.failure},
          {"factors", std::move(factors)}};
}

}  // namespace

Json json_from(const Hunt& hunt, const HuntResult& result) {
  Json axes = Json::array();
  for (const SweepAxis& axis : hunt.sweep.axes) {
    axes.push_back({{"name", axis.name}, {"label", axis.label}, {"unit", axis.unit}});
  }
  Json flights = Json::array();
  for (const HuntedFlight& flight : result.flights) flights.push_back(json_of_flight(flight));
  Json document = {{"title", hunt.sweep.title},
                   {"scenario", hunt.sweep.scenario_file.string()},
                   {"estimator", hunt.estimator},
                   {"method", method_name(hunt.method)},
                   {"seed", hunt.seed},
                   {"most_flights", hunt.most_flights},
                   {"axes", std::move(axes)},
                   {"flights_to_failure", nullptr},
                   {"exhausted", result.exhausted},
                   {"cancelled", result.cancelled},
                   {"worst", nullptr},
                   {"flights", std::move(flights)}};
  if (const auto count = result.flights_to_failure()) document["flights_to_failure"] = *count;
  if (const HuntedFlight* worst = result.worst()) {
    document["worst"] = worst - result.flights.data();
  }
  return document;
}

std::string markdown_from(const Hunt& hunt, const HuntResult& result) {
  std::string head = "| flight |";
  std::string rule = "|---|";
  for (const SweepAxis& axis : hunt.sweep.axes) {
    head += " " + axis.label + (axis.unit.empty() ? "" : " [" + axis.unit + "]") + " |";
    rule += "---|";
  }
  std::string text = head + " margin | result |\n" + rule + "---|---|\n";
  std::size_t number = 0;
  for (const HuntedFlight& flight : result.flights) {
    text += "| " + std::to_string(++number) + " |";
    for (const SweepAxis& axis : hunt.sweep.axes) {
      text += " " + plain_text(flight.cell.values.at(axis.name)) + " |";
    }
    char margin[32];
    std::snprintf(margin, sizeof margin, " %.3f | ", flight.margin.value);
    text += margin + (flight.margin.failed ? flight.margin.failure : "survives") + " |\n";
  }
  return text;
}

std::string summary_text(const Hunt& hunt, const HuntResult& result) {
  const HuntedFlight* worst = result.worst();
  if (worst == nullptr) return "No flight was flown.\n";
  std::string text;
  if (const auto count = result.flights_to_failure()) {
    text = "Flight " + std::to_string(*count) + " is the first one that estimator " +
           hunt.estimator + " fails";
  } else {
    text = "Estimator " + hunt.estimator + " survives all of " +
           counted(result.flights.size(), "flight");
  }
  if (result.exhausted) text += "; every point of the axes was flown";
  return text + ". The worst flight " + result_text(*worst) + "\n(" +
         cell_text(worst->cell.values) + ", seed = " + std::to_string(worst->seed) + ").\n";
}

}  // namespace overfly::server::experiments
