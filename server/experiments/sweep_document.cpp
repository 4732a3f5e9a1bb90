#include "server/experiments/sweep_document.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "core/outside/outside_json.hpp"
#include "core/time.hpp"
#include "server/files/json_schema.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const JsonSchema& sweep_schema() {
  static const JsonSchema instance(
      json_from_outside<Json>(sweep_schema_text(), "the sweeps' schema").value());
  return instance;
}

std::vector<Override> changes_from(const Json& object) {
  std::vector<Override> changes;
  for (const auto& [path, value] : object.items()) changes.push_back({path, value});
  return changes;
}

/// from + i * step, which is meant to be decimal: the shortest decimal within the error of the
/// arithmetic. 0.3, not 0.30000000000000004, which no `skip` and no other sweep would name.
double value_of_range(double from, double step, std::size_t i) {
  constexpr int kMostDecimals = 17;
  const double added = static_cast<double>(i) * step;
  const double value = from + added;
  const double error = 2.0 * std::numeric_limits<double>::epsilon() * (std::abs(from) + added);
  if (error > 1e-6 * step) return value;  // hardly distinct values stay as they are
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
    const double scale = std::pow(10.0, decimals);
    const double rounded = std::round(value * scale) / scale;
    if (std::abs(rounded - value) <= error) return rounded + 0.0;  // never -0
  }
  return value;
}

/// Values of a range with steps; the end counts if it is met within a billionth of a step.
std::vector<AxisValue> values_of_range(const std::string& path,
                                       double from,
                                       double to,
                                       double step) {
  std::vector<AxisValue> values;
  const auto steps = static_cast<std::size_t>(std::floor((to - from) / step + 1e-9));
  for (std::size_t i = 0; i <= steps; ++i) {
    const Json value = value_of_range(from, step, i);
    values.push_back({value, {{path, value}}});
  }
  return values;
}

/// Cells are known by their values: two with the same ones would be one.
Status check_distinct(const SweepAxis& axis, const std::string& values, const std::string& member) {
  std::set<Json> known;
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    const Json& value = axis.values[i].value;
    if (known.insert(value).second) continue;
    return Error{ErrorCode::kInvalidArgument,
                 values + "." + std::to_string(i) + member + " = " +
                     (value.is_string() ? value.get<std::string>() : value.dump()) +
                     ": must differ from those before it"};
  }
  return {};
}

Result<SweepAxis> axis_from(const Json& axis, const std::string& field) {
  SweepAxis result;
  const bool named = axis.contains("variants");
  result.name = axis.at(named ? "name" : "path").get<std::string>();
  result.label = axis.value("label", result.name);
  result.unit = axis.value("unit", "");
  if (named) {
    for (const Json& variant : axis.at("variants")) {
      result.values.push_back({variant.at("value"), changes_from(variant.at("set"))});
    }
    if (Status status = check_distinct(result, field + ".variants", ".value"); !status) {
      return status.error();
    }
  } else if (axis.contains("values")) {
    for (const Json& value : axis.at("values")) {
      result.values.push_back({value, {{result.name, value}}});
    }
    if (Status status = check_distinct(result, field + ".values", ""); !status) {
      return status.error();
    }
  } else {
    const double from = axis.at("from").get<double>();
    const double to = axis.at("to").get<double>();
    const Error reversed{ErrorCode::kInvalidArgument,
                         field + ".to = " + axis.at("to").dump() + ": must be at least " + field +
                             ".from = " + axis.at("from").dump()};
    if (!(to >= from)) return reversed;
    result.range = {from, to};
    if (axis.contains("step")) {
      const double step = axis.at("step").get<double>();
      if ((to - from) / step >= static_cast<double>(kMaxCells)) {
        return Error{ErrorCode::kInvalidArgument,
                     field + ".step = " + axis.at("step").dump() + ": gives more than " +
                         std::to_string(kMaxCells) + " values"};
      }
      result.values = values_of_range(result.name, from, to, step);
    }
  }
  return result;
}

Result<std::vector<SweepAxis>> axes_from(const Json& axes) {
  std::vector<SweepAxis> result;
  std::set<std::string> names;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string field = "axes." + std::to_string(i);
    Result<SweepAxis> axis = axis_from(axes[i], field);
    if (!axis) return axis.error();
    if (!names.insert(axis->name).second) {
      return Error{ErrorCode::kInvalidArgument,
                   field + " = " + axis->name + ": must be another axis than those before it"};
    }
    result.push_back(std::move(*axis));
  }
  return result;
}

RepeatRule repeats_from(const Json& document) {
  RepeatRule rule;
  if (!document.contains("repeats")) return rule;
  const Json& repeats = document.at("repeats");
  rule.most = repeats.at("most").get<int>();
  if (repeats.contains("half_width")) rule.half_width = repeats.at("half_width").get<double>();
  rule.vary_world = repeats.at("vary_world").get<bool>();
  rule.vary_start_s = repeats.at("vary_start_s").get<double>();
  return rule;
}

/// By how much a repeat starts later than the first one, in whole milliseconds.
double later_s(int repeat, const RepeatRule& rule) {
  const double turns = static_cast<double>(repeat) * std::numbers::phi;
  return std::floor((turns - std::floor(turns)) * rule.vary_start_s * 1e3) / 1e3;
}

/// Debug images are most of a run folder: hundreds of flights have fewer, unless the sweep asks for
/// more.
void record_less(const std::vector<Override>& changes, Scenario& scenario) {
  const bool asked = std::any_of(changes.begin(), changes.end(), [](const Override& change) {
    return change.path == "recording.debug_hz" ||
           (change.path == "recording" && change.value.contains("debug_hz"));
  });
  if (asked || scenario.record_debug_hz <= kSweepDebugHz) return;
  scenario.record_debug_hz = kSweepDebugHz;
  scenario.resolved["recording"]["debug_hz"] = kSweepDebugHz;
}

}  // namespace

Result<Sweep> resolve_sweep(Json document, const fs::path& folder) {
  std::string messages;
  for (const SchemaViolation& violation : sweep_schema().violations(document)) {
    messages += (messages.empty() ? "" : "\n") + violation.text;
  }
  if (!messages.empty()) return Error{ErrorCode::kInvalidArgument, messages};
  sweep_schema().apply_defaults(document);
  Sweep sweep;
  sweep.title = document.at("title").get<std::string>();
  const fs::path scenario = document.at("scenario").get<std::string>();
  sweep.scenario_file = (folder / scenario).lexically_normal();
  if (document.contains("set")) sweep.changes = changes_from(document.at("set"));
  if (document.contains("estimators")) {
    sweep.changes.push_back({"estimators", document.at("estimators")});
  }
  Result<std::vector<SweepAxis>> axes = axes_from(document.at("axes"));
  if (!axes) return axes.error();
  sweep.axes = std::move(*axes);
  if (document.contains("latin_hypercube")) {
    const Json& drawn = document.at("latin_hypercube");
    sweep.latin_hypercube = {drawn.at("cells").get<std::size_t>(),
                             drawn.at("seed").get<std::uint64_t>()};
  }
  if (document.contains("skip")) sweep.skip = document.at("skip").get<std::vector<Json>>();
  sweep.repeats = repeats_from(document);
  sweep.timeout_s = document.at("timeout_s").get<double>();
  sweep.retries = document.at("retries").get<int>();
  sweep.document = std::move(document);
  return sweep;
}

Result<Sweep> load_sweep(const fs::path& file) {
  Result<Json> document = read_json(file, kMaxSweepBytes);
  if (!document) return document.error();
  const fs::path folder = fs::absolute(file).parent_path().lexically_normal();
  Result<Sweep> sweep = resolve_sweep(std::move(*document), folder);
  if (!sweep) return sweep.error().in(file.string());
  return sweep;
}

Result<Scenario> scenario_of(const Sweep& sweep, const SweepCell& cell, int repeat) {
  std::vector<Override> changes = sweep.changes;
  changes.insert(changes.end(), cell.changes.begin(), cell.changes.end());
  const auto in_cell = [&](const Error& error) {
    return cell.values.empty() ? error : error.in(cell_text(cell.values));
  };
  Result<Scenario> scenario = load_scenario(sweep.scenario_file, changes, sweep.sources);
  if (!scenario) return in_cell(scenario.error());
  if (repeat > 0) {
    const auto added = static_cast<std::uint64_t>(repeat);
    changes.push_back({"seed", scenario->seed + added});
    if (sweep.repeats.vary_world) {
      const auto* world = std::get_if<BuiltinWorld>(&scenario->world);
      if (world == nullptr) {
        return in_cell({ErrorCode::kInvalidArgument,
                        "repeats.vary_world = true: must be false with a world of files"});
      }
      changes.push_back({"world.builtin.seed", world->seed + added});
    }
    if (sweep.repeats.vary_start_s > 0.0) {
      const double start_s = s_from_ns(scenario->start_ns) + later_s(repeat, sweep.repeats);
      changes.push_back({"start_s", start_s});
    }
    scenario = load_scenario(sweep.scenario_file, changes, sweep.sources);
    if (!scenario) return in_cell(scenario.error());
  }
  record_less(changes, *scenario);
  scenario->sources = sweep.sources;
  if (Status status = check_scenario(*scenario); !status) return in_cell(status.error());
  if (!sweep.check) return scenario;
  if (Status status = sweep.check(*scenario); !status) return in_cell(status.error());
  return scenario;
}

std::string cell_text(const Json& values) {
  std::string text;
  for (const auto& [name, value] : values.items()) {
    text += (text.empty() ? "" : ", ") + name + " = " +
            (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

}  // namespace overfly::server::experiments
