#include "server/experiments/hunt/hunt_document.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>

#include "core/outside/outside_json.hpp"
#include "server/files/json_schema.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const JsonSchema& hunt_schema() {
  static const JsonSchema instance(
      json_from_outside<Json>(hunt_schema_text(), "the hunts' schema").value());
  return instance;
}

Error invalid_hunt(const std::string& text) { return {ErrorCode::kInvalidArgument, text}; }

/// The same flights as a sweep, whose schema checks axes and changes.
Json sweep_document_of(const Json& hunt) {
  Json sweep = {{"format_version", 1}};
  for (const char* name :
       {"title", "description", "scenario", "set", "axes", "timeout_s", "retries"}) {
    if (hunt.contains(name)) sweep[name] = hunt.at(name);
  }
  if (hunt.contains("estimator")) sweep["estimators"] = Json::array({hunt.at("estimator")});
  sweep["repeats"] = {{"most", hunt.at("repeats")}};
  return sweep;
}

/// Keeps one estimator of the base scenario.
Status choose_estimator(Hunt& hunt, const std::string& wanted) {
  const Result<Scenario> base =
      load_scenario(hunt.sweep.scenario_file, hunt.sweep.changes, hunt.sweep.sources);
  if (!base) return base.error();
  std::string names;
  for (const Json& entry : base->resolved.at("estimators")) {
    const auto name = entry.at("name").get<std::string>();
    names += (names.empty() ? "" : ", ") + name;
    if (!wanted.empty() && name != wanted) continue;
    hunt.estimator = name;
    hunt.sweep.changes.push_back({"estimators", Json::array({entry})});
    return {};
  }
  if (names.empty()) return invalid_hunt("estimators: must have at least one");
  return invalid_hunt("estimator = " + wanted + ": must be one of " + names);
}

/// Resolves the flights at the middle and at each corner, before any is flown.
Status check_limits_of(const Hunt& hunt) {
  const auto axes = static_cast<Eigen::Index>(hunt.sweep.axes.size());
  for (std::size_t corner = 0; corner <= std::size_t{1} << hunt.sweep.axes.size(); ++corner) {
    Eigen::VectorXd point = Eigen::VectorXd::Constant(axes, 0.5);
    for (Eigen::Index axis = 0; corner > 0 && axis < axes; ++axis) {
      point(axis) = static_cast<double>(((corner - 1) >> static_cast<unsigned>(axis)) & 1U);
    }
    const Result<Scenario> scenario = scenario_of(hunt.sweep, cell_at(hunt, point), 0);
    if (!scenario) return scenario.error();
    if (scenario->is_live()) {
      return Error{ErrorCode::kUnsupported, "flight: must not be live in a hunt"};
    }
  }
  return {};
}

std::optional<double> number_from(std::string_view text) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// A value of a range with seven digits, which is more than a search needs and can be read.
double value_between(const std::pair<double, double>& range, double share) {
  const double value = range.first + share * (range.second - range.first);
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return std::clamp(number_from(text).value_or(value), range.first, range.second);
}

}  // namespace

Result<Json> parse_axis(const std::string& text) {
  const Error wrong =
      invalid_hunt("--axis " + text + ": must be PATH=FROM:TO or PATH=FROM:TO:STEP");
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return wrong;
  std::vector<double> numbers;
  for (std::size_t begin = equals + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    const auto number = number_from(std::string_view(text).substr(begin, end - begin));
    if (!number) return wrong;
    numbers.push_back(*number);
    begin = end + 1;
  }
  if (numbers.size() != 2 && numbers.size() != 3) return wrong;
  Json axis = {{"path", text.substr(0, equals)}, {"from", numbers[0]}, {"to", numbers[1]}};
  if (numbers.size() == 3) axis["step"] = numbers[2];
  return axis;
}

Result<Json> read_hunt_document(const fs::path& file) {
  Result<Json> document = read_json(file, kMaxSweepBytes);
  if (!document) return document;
  if (!document->is_object()) {
    return Error{ErrorCode::kUnreadable, file.string() + ": is no JSON object"};
  }
  if (document->contains("axes")) return document;
  Json hunt = {
      {"format_version", 1}, {"scenario", file.filename().string()}, {"axes", Json::array()}};
  if (document->contains("title")) hunt["title"] = document->at("title");
  return hunt;
}

Result<Hunt> resolve_hunt(Json document,
                          const fs::path& folder,
                          const std::string& estimator,
                          const HuntLimits& limits) {
  std::string messages;
  for (const SchemaViolation& violation : hunt_schema().violations(document)) {
    messages += (messages.empty() ? "" : "\n") + violation.text;
  }
  if (!messages.empty()) return invalid_hunt(messages);
  hunt_schema().apply_defaults(document);
  Result<Sweep> sweep = resolve_sweep(sweep_document_of(document), folder);
  if (!sweep) return sweep.error();

  Hunt hunt;
  hunt.sweep = std::move(*sweep);
  hunt.sweep.sources = limits.sources;
  hunt.sweep.check = limits.check;
  hunt.method = document.at("method") == "random" ? SearchMethod::kRandom : SearchMethod::kModel;
  hunt.stop_at_failure = document.at("until") == "failure";
  hunt.most_flights = document.at("most_flights").get<std::size_t>();
  hunt.batch = document.at("batch").get<std::size_t>();
  hunt.seed = document.at("seed").get<std::uint64_t>();
  if (document.contains("position_rmse_limit_m")) {
    hunt.rule.position_rmse_limit_m = document.at("position_rmse_limit_m").get<double>();
  }
  hunt.rule.alignment =
      evaluation::alignment_mode_from(document.at("alignment").get<std::string>()).value();
  const auto repeats = document.at("repeats").get<std::size_t>();
  if (hunt.most_flights < repeats) {
    return invalid_hunt("most_flights = " + std::to_string(hunt.most_flights) +
                        ": must be at least repeats = " + std::to_string(repeats));
  }
  if (document.contains("estimator") && !estimator.empty()) {
    return invalid_hunt("estimator = " + estimator + ": the hunt file has one of its own");
  }
  if (Status status = choose_estimator(hunt, estimator); !status) return status.error();
  if (Status status = check_limits_of(hunt); !status) return status.error();
  return hunt;
}

std::vector<SearchAxis> search_axes(const Hunt& hunt) {
  std::vector<SearchAxis> axes;
  for (const SweepAxis& axis : hunt.sweep.axes) axes.push_back({axis.values.size()});
  return axes;
}

SweepCell cell_at(const Hunt& hunt, const Eigen::VectorXd& point) {
  SweepCell cell{Json::object(), {}};
  for (std::size_t i = 0; i < hunt.sweep.axes.size(); ++i) {
    const SweepAxis& axis = hunt.sweep.axes[i];
    const double share = point(static_cast<Eigen::Index>(i));
    if (axis.values.empty()) {
      const Json value = value_between(*axis.range, share);
      cell.values[axis.name] = value;
      cell.changes.push_back({axis.name, value});
      continue;
    }
    const auto count = static_cast<double>(axis.values.size());
    const auto index = static_cast<std::size_t>(std::min(std::floor(share * count), count - 1.0));
    cell.values[axis.name] = axis.values[index].value;
    cell.changes.insert(
        cell.changes.end(), axis.values[index].changes.begin(), axis.values[index].changes.end());
  }
  return cell;
}

}  // namespace overfly::server::experiments
