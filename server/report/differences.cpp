#include "server/report/differences.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace overfly::server::report {
namespace {

using Json = nlohmann::json;
using Leaves = std::vector<std::pair<std::string, std::string>>;

/// The name that stands for each element of an array; empty if their numbers do.
std::vector<std::string> element_names(const Json& array) {
  std::vector<std::string> names;
  for (const Json& element : array) {
    const auto name = element.is_object() ? element.find("name") : element.end();
    if (!element.is_object() || name == element.end() || !name->is_string()) return {};
    names.push_back(name->get<std::string>());
  }
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() != names.size()) return {};
  return names;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The depth is that of documents from outside: at most kMaxJsonDepth.
// NOLINTNEXTLINE(misc-no-recursion)
void add_leaves(const std::string& path, const Json& value, Leaves& leaves) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (value.is_object() && !value.empty()) {
    for (const auto& [key, member] : value.items()) add_leaves(prefix + key, member, leaves);
  } else if (value.is_array() && !value.empty()) {
    const std::vector<std::string> names = element_names(value);
    for (std::size_t i = 0; i < value.size(); ++i) {
      add_leaves(prefix + (names.empty() ? std::to_string(i) : names[i]), value[i], leaves);
    }
  } else {
    leaves.emplace_back(path, value_text(value));
  }
}

bool all_the_same(const std::vector<std::optional<std::string>>& values) {
  return std::all_of(
      values.begin(), values.end(), [&](const auto& value) { return value == values.front(); });
}

}  // namespace

std::vector<std::pair<std::string, std::string>> leaves_of(const Json& document) {
  Leaves leaves;
  add_leaves("", document, leaves);
  return leaves;
}

Differences differences_between(const std::vector<Json>& documents, std::size_t most) {
  std::map<std::string, std::vector<std::optional<std::string>>> fields;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    for (const auto& [field, value] : leaves_of(documents[i])) {
      std::vector<std::optional<std::string>>& values = fields[field];
      values.resize(documents.size());
      values[i] = value;
    }
  }
  Differences differences;
  for (auto& [field, values] : fields) {
    if (all_the_same(values)) continue;
    if (differences.fields.size() < most) {
      differences.fields.push_back({field, std::move(values)});
    } else {
      ++differences.left_out;
    }
  }
  return differences;
}

}  // namespace overfly::server::report
