// Parameters and presets of an upstream system. C++11 (see upstream_system.hpp).
#pragma once

#include <map>
#include <string>
#include <vector>

namespace overfly_adapters {

/// By upstream's names; numbers as decimals with a point, flags as "true" or "false".
using ParameterValues = std::map<std::string, std::string>;

enum class ParameterKind {
  kNumber,
  kWhole,       ///< number without a fraction
  kAutoNumber,  ///< number, or "auto": what upstream would take by itself
  kFlag,
  kAutoFlag,  ///< "true", "false", or "auto": one of them by the session
  kText
};

struct ParameterDeclaration {
  std::string name;
  ParameterKind kind;
  std::string standard;  ///< upstream's default; empty = must be given
  double minimum;        ///< of numbers, as the maximum
  double maximum;
};

struct Preset {
  std::string name;
  ParameterValues values;
  std::string refusal;  ///< why it is not taken, where upstream has it and we have not
};

/// The names an adapter takes, besides `preset`.
class ParameterSet {
 public:
  ParameterSet(std::vector<ParameterDeclaration> declarations, std::vector<Preset> presets);

  /// Defaults, overwritten by the preset's values, overwritten by those wanted by name.
  /// Throws std::runtime_error naming the parameter, its value and what may stand there.
  ParameterValues resolve(const ParameterValues& wanted) const;

  /// Those that `wanted` or its preset asks for, less the ones that leave the choice to the
  /// adapter: what the running system must have in force.
  ParameterValues asked_for(const ParameterValues& wanted) const;

 private:
  const ParameterDeclaration* find(const std::string& name) const;
  const Preset& preset_of(const ParameterValues& wanted) const;
  std::string known_names() const;

  std::vector<ParameterDeclaration> declarations_;
  std::vector<Preset> presets_;
};

/// Without those that are "auto".
ParameterValues decided(ParameterValues values);
/// Of a resolved value.
double number_of(const ParameterValues& values, const std::string& name);
/// "auto" becomes `automatic`.
bool flag_of(const ParameterValues& values, const std::string& name, bool automatic = false);
/// As short as reads back the same.
std::string text_of_number(double value);
std::string text_of_flag(bool value);

/// Throws std::runtime_error when the running system has another value in force than asked for:
/// such a run would be about something else than its scenario says.
void check_in_force(const ParameterValues& asked_for, const ParameterValues& effective);

}  // namespace overfly_adapters
