// Reads and writes an estimator's parameters by name, with their limits.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"

namespace overfly::odometry {

/// kInvalidArgument: "parameters.FIELD = VALUE: must be LIMIT".
[[nodiscard]] Error parameter_error(const std::string& field,
                                    double value,
                                    const std::string& limit);

/// A finite number without a fraction.
[[nodiscard]] bool is_whole(double value);

/// The fields of the struct `Parameters` by name. A name is also the key of a scenario's
/// `parameters`.
template <typename Parameters>
struct ParameterTable {
  struct Whole {
    const char* name;
    int low;   ///< inclusive
    int high;  ///< inclusive
    int Parameters::*field;
  };
  struct Switch {
    const char* name;
    bool Parameters::*field;
  };
  struct Number {
    const char* name;
    bool (*holds)(double);  ///< whether a value is within the limit
    const char* limit;      ///< as the error message states it
    double Parameters::*field;
  };
  /// Of random numbers, in [0, 2^53]: above, JSON numbers cannot represent every integer.
  struct Seed {
    const char* name;
    std::uint64_t Parameters::*field;
  };

  std::string estimator;  ///< named in error messages
  std::vector<Whole> wholes;
  std::vector<Switch> switches;
  std::vector<Number> numbers;
  std::vector<Seed> seeds;

  /// The default parameters with these values; switches are 1 and 0.
  /// Errors: kInvalidArgument naming an unknown key, or field, value and limit.
  [[nodiscard]] Result<Parameters> read(const std::map<std::string, double>& values) const;
  /// What `read` makes the same parameters of.
  [[nodiscard]] std::map<std::string, double> values_of(const Parameters& parameters) const;
  /// The values as text; switches are "true" and "false".
  [[nodiscard]] std::map<std::string, std::string> texts_of(const Parameters& parameters) const;

 private:
  /// Sets one field; false for an unknown name.
  [[nodiscard]] Result<bool> set(const std::string& name, double value, Parameters& to) const;
  [[nodiscard]] std::string known_names() const;
};

template <typename Parameters>
Result<bool> ParameterTable<Parameters>::set(const std::string& name,
                                             double value,
                                             Parameters& to) const {
  for (const Whole& whole : wholes) {
    if (name != whole.name) continue;
    if (!is_whole(value) || value < whole.low || value > whole.high) {
      return parameter_error(name,
                             value,
                             "a whole number in [" + std::to_string(whole.low) + ", " +
                                 std::to_string(whole.high) + "]");
    }
    to.*whole.field = static_cast<int>(value);
    return true;
  }
  for (const Switch& option : switches) {
    if (name != option.name) continue;
    if (value != 0.0 && value != 1.0) {
      return parameter_error(name, value, "true or false (1 or 0)");
    }
    to.*option.field = value != 0.0;
    return true;
  }
  for (const Number& number : numbers) {
    if (name != number.name) continue;
    if (!number.holds(value)) return parameter_error(name, value, number.limit);
    to.*number.field = value;
    return true;
  }
  for (const Seed& seed : seeds) {
    if (name != seed.name) continue;
    if (!is_whole(value) || value < 0.0 || value > 9007199254740992.0) {
      return parameter_error(name, value, "a whole number in [0, 2^53]");
    }
    to.*seed.field = static_cast<std::uint64_t>(value);
    return true;
  }
  return false;
}

template <typename Parameters>
std::string ParameterTable<Parameters>::known_names() const {
  std::string names;
  for (const auto& [name, value] : values_of(Parameters{})) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

template <typename Parameters>
Result<Parameters> ParameterTable<Parameters>::read(
    const std::map<std::string, double>& values) const {
  Parameters parameters;
  for (const auto& [name, value] : values) {
    const Result<bool> known = set(name, value, parameters);
    if (!known) return known.error();
    if (!known.value()) {
      return Error{ErrorCode::kInvalidArgument,
                   "parameters." + name + ": not a parameter of the " + estimator + " estimator (" +
                       known_names() + ")"};
    }
  }
  return parameters;
}

template <typename Parameters>
std::map<std::string, double> ParameterTable<Parameters>::values_of(
    const Parameters& parameters) const {
  std::map<std::string, double> values;
  for (const Whole& whole : wholes) values[whole.name] = parameters.*whole.field;
  for (const Switch& option : switches) values[option.name] = parameters.*option.field ? 1.0 : 0.0;
  for (const Number& number : numbers) values[number.name] = parameters.*number.field;
  for (const Seed& seed : seeds) values[seed.name] = static_cast<double>(parameters.*seed.field);
  return values;
}

template <typename Parameters>
std::map<std::string, std::string> ParameterTable<Parameters>::texts_of(
    const Parameters& parameters) const {
  std::map<std::string, std::string> texts;
  for (const auto& [name, value] : values_of(parameters)) texts[name] = text_of(value);
  for (const Switch& option : switches) texts[option.name] = text_of(parameters.*option.field);
  return texts;
}

}  // namespace overfly::odometry
