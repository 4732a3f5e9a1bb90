// Parameters and presets of an upstream system. C++11 (see upstream_system.hpp).
#pragma once

#include <map>
#include <string>
#include <vector>

namespace overfly_adapters {

/// Values by upstream's names: numbers as decimals with a point, flags as "true" or "false".
using ParameterValues = std::map<std::string, std::string>;

enum class ParameterKind {
  kNumber,
  kWhole,       ///< integer
  kAutoNumber,  ///< number, or "auto": upstream's choice
  kFlag,
  kAutoFlag,  ///< "true", "false", or "auto": depends on the session
  kText
};

struct ParameterDeclaration {
  std::string name;
  ParameterKind kind;
  std::string standard;  ///< upstream's default; empty = must be given
  double minimum;        ///< minimum and maximum apply to numbers
  double maximum;
};

struct Preset {
  std::string name;
  ParameterValues values;
  std::string refusal;  ///< why the adapter does not support this preset of upstream
};

/// The parameters of an adapter, in addition to `preset`.
class ParameterSet {
 public:
  ParameterSet(std::vector<ParameterDeclaration> declarations, std::vector<Preset> presets);

  /// Defaults, overwritten by the preset's values, then by those requested by name. Throws
  /// std::runtime_error naming the parameter, its value and the allowed values.
  ParameterValues resolve(const ParameterValues& wanted) const;

  /// The values requested in `wanted` or by its preset, without those left to the adapter. The
  /// running system must use them.
  ParameterValues asked_for(const ParameterValues& wanted) const;

 private:
  const ParameterDeclaration* find(const std::string& name) const;
  const Preset& preset_of(const ParameterValues& wanted) const;
  std::string known_names() const;

  std::vector<ParameterDeclaration> declarations_;
  std::vector<Preset> presets_;
};

/// Removes values that are "auto".
ParameterValues decided(ParameterValues values);
/// A resolved value as a number.
double number_of(const ParameterValues& values, const std::string& name);
/// A resolved value as a flag; "auto" gives `automatic`.
bool flag_of(const ParameterValues& values, const std::string& name, bool automatic = false);
/// The shortest text that reads back as the same number.
std::string text_of_number(double value);
std::string text_of_flag(bool value);

/// Throws std::runtime_error if the running system uses another value than requested: the run would
/// not match its scenario.
void check_in_force(const ParameterValues& asked_for, const ParameterValues& effective);

}  // namespace overfly_adapters
