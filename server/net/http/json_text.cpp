#include "server/net/http/json_text.hpp"

#include <cmath>
#include <utility>

#include "core/outside/outside_json.hpp"

namespace overfly::net {
namespace {

/// A value as shown in a message, truncated to a fixed length.
std::string shown(const nlohmann::json& value) {
  if (value.is_object()) return "{...}";
  if (value.is_array()) return "[...]";
  std::string text = to_text(value);
  constexpr std::size_t kMaxShown = 60;
  if (text.size() > kMaxShown) text = text.substr(0, kMaxShown) + "...";
  return text;
}

}  // namespace

std::string to_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<nlohmann::json> parse_object(const std::string& text, const std::string& what) {
  Result<nlohmann::json> json = json_from_outside<nlohmann::json>(text, what);
  if (!json) return Error{ErrorCode::kInvalidArgument, json.error().message};
  if (!json->is_object()) {
    return Error{ErrorCode::kInvalidArgument, what + " must be a JSON object"};
  }
  return json;
}

JsonFields::JsonFields(const nlohmann::json& object, std::string where)
    : object_(object), where_(std::move(where)) {}

std::string JsonFields::full_name(const std::string& name) const {
  return where_.empty() ? name : where_ + "." + name;
}

const nlohmann::json* JsonFields::find(const std::string& name) {
  known_.insert(name);
  const auto found = object_.find(name);
  return found == object_.end() ? nullptr : &*found;
}

void JsonFields::reject(const std::string& name, const std::string& message) {
  if (!error_) error_ = Error{ErrorCode::kInvalidArgument, full_name(name) + message};
}

void JsonFields::reject_value(const std::string& name, const std::string& limit) {
  reject(name, " = " + shown(object_.at(name)) + ": must be " + limit);
}

void JsonFields::require(const std::string& name) {
  if (!object_.contains(name)) reject(name, ": is required");
}

std::optional<std::string> JsonFields::text(const std::string& name) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) return value->get<std::string>();
  reject_value(name, "a string");
  return std::nullopt;
}

std::optional<double> JsonFields::number(const std::string& name, double min, double max) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  const std::string limit =
      "in [" + to_text(nlohmann::json(min)) + ", " + to_text(nlohmann::json(max)) + "]";
  if (value->is_number()) {
    const auto number = value->get<double>();
    if (number >= min && number <= max) return number;
    reject_value(name, limit);
  } else {
    reject_value(name, "a number " + limit);
  }
  return std::nullopt;
}

std::optional<std::int64_t> JsonFields::integer(const std::string& name,
                                                std::int64_t min,
                                                std::int64_t max) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  // Beyond 2^53 doubles are not exact, and 2^63 cannot be converted: such values must be integers.
  constexpr double kExact = 9007199254740992.0;
  std::optional<std::int64_t> integer;
  if (value->is_number_unsigned()) {
    const auto number = value->get<std::uint64_t>();
    if (number <= static_cast<std::uint64_t>(INT64_MAX))
      integer = static_cast<std::int64_t>(number);
  } else if (value->is_number_integer()) {
    integer = value->get<std::int64_t>();
  } else if (value->is_number_float()) {
    const auto number = value->get<double>();
    if (std::abs(number) <= kExact && std::floor(number) == number) {
      integer = static_cast<std::int64_t>(number);
    }
  }
  if (integer && *integer >= min && *integer <= max) return integer;
  reject_value(name, "an integer in [" + std::to_string(min) + ", " + std::to_string(max) + "]");
  return std::nullopt;
}

std::optional<bool> JsonFields::boolean(const std::string& name) {
  const nlohmann::json* value = find(name);
  if (value == nullptr) return std::nullopt;
  if (value->is_boolean()) return value->get<bool>();
  reject_value(name, "true or false");
  return std::nullopt;
}

const nlohmann::json* JsonFields::object(const std::string& name) {
  const nlohmann::json* value = find(name);
  if (value == nullptr || value->is_object()) return value;
  reject_value(name, "an object");
  return nullptr;
}

const nlohmann::json* JsonFields::array(const std::string& name) {
  const nlohmann::json* value = find(name);
  if (value == nullptr || value->is_array()) return value;
  reject_value(name, "an array");
  return nullptr;
}

Status JsonFields::finish() {
  for (const auto& [name, value] : object_.items()) {
    if (!known_.contains(name)) reject(name, ": is not a known field");
  }
  if (error_) return *error_;
  return {};
}

}  // namespace overfly::net
