#include "server/record/comparison/differences.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace overfly::server {
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

std::string compared_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// NOLINTNEXTLINE(misc-no-recursion): documents from outside are at most kMaxJsonDepth deep
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
    leaves.emplace_back(path, compared_text(value));
  }
}

/// A value of each document; null where it is absent.
using Values = std::vector<const Json*>;

bool all_the_same(const Values& values) {
  return std::all_of(values.begin(), values.end(), [&](const Json* value) {
    const Json* first = values.front();
    return value == nullptr || first == nullptr ? value == first : *value == *first;
  });
}

/// The members of an object, or of an array by name or number.
std::map<std::string, const Json*> members_of(const Json& value) {
  std::map<std::string, const Json*> members;
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) members[key] = &member;
    return members;
  }
  const std::vector<std::string> names = element_names(value);
  for (std::size_t i = 0; i < value.size(); ++i) {
    members[names.empty() ? std::to_string(i) : names[i]] = &value[i];
  }
  return members;
}

/// Whether the values are all objects or all arrays, so that their members can be compared.
bool have_members(const Values& values) {
  const auto all = [&](bool (Json::*is)() const noexcept) {
    return std::all_of(values.begin(), values.end(), [&](const Json* value) {
      return value != nullptr && (value->*is)();
    });
  };
  return all(&Json::is_object) || all(&Json::is_array);
}

void add_difference(const std::string& path,
                    const Values& values,
                    std::size_t most,
                    Differences& differences) {
  if (differences.fields.size() >= most) {
    ++differences.left_out;
    return;
  }
  Difference& difference = differences.fields.emplace_back();
  difference.field = path;
  for (const Json* value : values) {
    difference.values.push_back(value == nullptr ? std::nullopt
                                                 : std::optional(compared_text(*value)));
  }
}

// NOLINTNEXTLINE(misc-no-recursion): documents from outside are at most kMaxJsonDepth deep
void add_differences(const std::string& path,
                     const Values& values,
                     std::size_t most,
                     Differences& differences) {
  if (all_the_same(values)) return;
  if (!have_members(values)) return add_difference(path, values, most, differences);
  std::map<std::string, Values> members;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const auto& [key, member] : members_of(*values[i])) {
      Values& each = members[key];
      each.resize(values.size());
      each[i] = member;
    }
  }
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const auto& [key, each] : members) add_differences(prefix + key, each, most, differences);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> leaves_of(const Json& document) {
  Leaves leaves;
  add_leaves("", document, leaves);
  return leaves;
}

Differences differences_between(const std::vector<Json>& documents, std::size_t most) {
  Values values;
  for (const Json& document : documents) values.push_back(&document);
  Differences differences;
  if (!values.empty()) add_differences("", values, most, differences);
  return differences;
}

}  // namespace overfly::server
