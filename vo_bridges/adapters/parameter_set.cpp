#include "vo_bridges/adapters/parameter_set.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace overfly_adapters {
namespace {

bool is_number(const std::string& text, double* value) {
  char* end = nullptr;
  *value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(*value);
}

void check_flag(const ParameterDeclaration& declaration, const std::string& text) {
  const bool automatic = declaration.kind == ParameterKind::kAutoFlag;
  if (text == "true" || text == "false" || (automatic && text == "auto")) return;
  throw std::runtime_error("parameter " + declaration.name + " = '" + text + "': must be true" +
                           (automatic ? ", false or auto" : " or false"));
}

void check_number(const ParameterDeclaration& declaration, const std::string& text) {
  double value = 0.0;
  const bool whole = declaration.kind == ParameterKind::kWhole;
  const bool automatic = declaration.kind == ParameterKind::kAutoNumber;
  if (automatic && text == "auto") return;
  if (is_number(text, &value) && value >= declaration.minimum && value <= declaration.maximum &&
      (!whole || value == std::floor(value))) {
    return;
  }
  throw std::runtime_error("parameter " + declaration.name + " = '" + text + "': must be a " +
                           (whole ? "whole " : "") + "number from " +
                           text_of_number(declaration.minimum) + " to " +
                           text_of_number(declaration.maximum) + (automatic ? " or auto" : ""));
}

void check(const ParameterDeclaration& declaration, const std::string& text) {
  switch (declaration.kind) {
    case ParameterKind::kNumber:
    case ParameterKind::kWhole:
    case ParameterKind::kAutoNumber:
      check_number(declaration, text);
      return;
    case ParameterKind::kFlag:
    case ParameterKind::kAutoFlag:
      check_flag(declaration, text);
      return;
    case ParameterKind::kText:
      break;
  }
  if (text.empty()) throw std::runtime_error("parameter " + declaration.name + " must be given");
}

/// Upstream stores many of them as float or int: values equal to seven digits count as equal.
bool same(const std::string& a, const std::string& b) {
  double number_a = 0.0;
  double number_b = 0.0;
  if (!is_number(a, &number_a) || !is_number(b, &number_b)) return a == b;
  return std::fabs(number_a - number_b) <= 1e-6 * std::fabs(number_a);
}

}  // namespace

ParameterSet::ParameterSet(std::vector<ParameterDeclaration> declarations,
                           std::vector<Preset> presets)
    : declarations_(std::move(declarations)), presets_(std::move(presets)) {}

ParameterValues ParameterSet::resolve(const ParameterValues& wanted) const {
  ParameterValues values;
  for (const ParameterDeclaration& declaration : declarations_) {
    values[declaration.name] = declaration.standard;
  }
  for (const auto& value : preset_of(wanted).values) values[value.first] = value.second;
  for (const auto& value : wanted) {
    if (value.first == "preset") continue;
    if (find(value.first) == nullptr) {
      throw std::runtime_error("parameter " + value.first + ": not one of preset" + known_names());
    }
    values[value.first] = value.second;
  }
  for (const ParameterDeclaration& declaration : declarations_) {
    check(declaration, values[declaration.name]);
  }
  return values;
}

ParameterValues ParameterSet::asked_for(const ParameterValues& wanted) const {
  ParameterValues values = preset_of(wanted).values;
  for (const auto& value : wanted) values[value.first] = value.second;
  values.erase("preset");
  return decided(std::move(values));
}

const ParameterDeclaration* ParameterSet::find(const std::string& name) const {
  for (const ParameterDeclaration& declaration : declarations_) {
    if (declaration.name == name) return &declaration;
  }
  return nullptr;
}

const Preset& ParameterSet::preset_of(const ParameterValues& wanted) const {
  static const Preset none;
  const auto name = wanted.find("preset");
  if (name == wanted.end() || name->second.empty()) return none;
  std::string known;
  for (const Preset& preset : presets_) {
    if (preset.name == name->second && preset.refusal.empty()) return preset;
    if (preset.name == name->second) {
      throw std::runtime_error("parameter preset = '" + preset.name + "': " + preset.refusal);
    }
    if (!preset.refusal.empty()) continue;
    known += (known.empty() ? "" : ", ") + preset.name;
  }
  throw std::runtime_error("parameter preset = '" + name->second + "': must be one of " + known);
}

std::string ParameterSet::known_names() const {
  std::string names;
  for (const ParameterDeclaration& declaration : declarations_) names += ", " + declaration.name;
  return names;
}

ParameterValues decided(ParameterValues values) {
  for (auto value = values.begin(); value != values.end();) {
    value = value->second == "auto" ? values.erase(value) : std::next(value);
  }
  return values;
}

double number_of(const ParameterValues& values, const std::string& name) {
  return std::strtod(values.at(name).c_str(), nullptr);
}

bool flag_of(const ParameterValues& values, const std::string& name, bool automatic) {
  const std::string& text = values.at(name);
  return text == "auto" ? automatic : text == "true";
}

std::string text_of_number(double value) {
  char text[32] = {};
  if (value == std::floor(value) && std::fabs(value) < 1e15) {
    std::snprintf(text, sizeof(text), "%.0f", value);
    return text;
  }
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof(text), "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

std::string text_of_flag(bool value) { return value ? "true" : "false"; }

void check_in_force(const ParameterValues& asked_for, const ParameterValues& effective) {
  for (const auto& asked : asked_for) {
    const auto in_force = effective.find(asked.first);
    const std::string value = in_force == effective.end() ? "nothing" : in_force->second;
    if (same(asked.second, value)) continue;
    throw std::runtime_error("parameter " + asked.first + " = " + asked.second +
                             " was requested, but the running system has " + value + " in effect");
  }
}

}  // namespace overfly_adapters
