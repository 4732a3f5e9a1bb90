#include "server/experiments/sweep_extent.hpp"

#include <algorithm>

#include "server/experiments/sweep_document.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

std::vector<std::string> estimators_of(const Json& sweep) {
  std::vector<std::string> names;
  const auto found = sweep.find("estimator_names");
  if (found == sweep.end() || !found->is_array()) return names;
  for (const Json& name : *found) {
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  return names;
}

std::optional<std::int64_t> most_repeats_of(const Json& sweep) {
  const auto repeats = sweep.find("repeats");
  if (repeats == sweep.end() || !repeats->is_object()) return std::nullopt;
  const auto most = repeats->find("most");
  if (most == repeats->end() || !most->is_number_integer()) return std::nullopt;
  return most->get<std::int64_t>();
}

/// Conditions of the schema's shape; the file may have come from anywhere.
std::vector<Json> skip_of(const Json& sweep) {
  std::vector<Json> skip;
  const auto found = sweep.find("skip");
  if (found == sweep.end() || !found->is_array()) return skip;
  const auto is_limit = [](const Json& value) { return value.is_number(); };
  for (const Json& entry : *found) {
    if (!entry.is_object() || entry.empty()) continue;
    const bool valid = std::all_of(entry.begin(), entry.end(), [&](const Json& condition) {
      return !condition.is_object() || std::all_of(condition.begin(), condition.end(), is_limit);
    });
    if (valid) skip.push_back(entry);
  }
  return skip;
}

}  // namespace

SweepExtent::SweepExtent(const Json& sweep) {
  if (!sweep.is_object()) return;
  estimators_ = estimators_of(sweep);
  most_repeats_ = most_repeats_of(sweep);
  skip_ = skip_of(sweep);
  const auto values = sweep.find("axis_values");
  if (values == sweep.end() || !values->is_object()) return;
  axis_values_.emplace();
  for (const auto& [axis, known] : values->items()) {
    (*axis_values_)[axis].insert(known.begin(), known.end());
  }
}

bool SweepExtent::contains(const SweepResult& result) const {
  if (most_repeats_ && result.repeat >= *most_repeats_) return false;
  const bool known =
      std::find(estimators_.begin(), estimators_.end(), result.estimator) != estimators_.end();
  return (known || estimators_.empty()) && (!axis_values_ || has_cell(result.cell)) &&
         !is_skipped(skip_, result.cell);
}

bool SweepExtent::has_cell(const Json& cell) const {
  if (!cell.is_object() || cell.size() != axis_values_->size()) return false;
  const auto items = cell.items();
  return std::all_of(items.begin(), items.end(), [&](const auto& item) {
    const auto values = axis_values_->find(item.key());
    return values != axis_values_->end() && values->second.contains(item.value());
  });
}

}  // namespace overfly::server::experiments
