// Reads the fields of a mapping of CSV files. Private to its reader.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace overfly::flight::logs {

using MappingJson = nlohmann::ordered_json;

/// An object of the mapping with its path in messages ("pieces.0.time").
class MappingObject {
 public:
  MappingObject(const MappingJson& json, std::string file, std::string path)
      : json_(json), file_(std::move(file)), path_(std::move(path)) {}

  [[nodiscard]] Error fault(const std::string& member, const std::string& what) const {
    std::string text = path_.empty() ? member : member.empty() ? path_ : path_ + "." + member;
    if (json_.is_object() && json_.contains(member)) text += " = " + shown(json_.at(member));
    return {ErrorCode::kInvalidArgument, file_ + ": " + text + ": " + what};
  }
  /// Errors: for anything but an object, and for members that are not in `known`.
  [[nodiscard]] Status expect_members(const std::vector<std::string>& known) const {
    if (!json_.is_object()) return fault("", "must be an object");
    for (const auto& [member, value] : json_.items()) {
      if (std::find(known.begin(), known.end(), member) != known.end()) continue;
      std::string names;
      for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
      return fault(member, "is unknown: must be one of " + names);
    }
    return {};
  }
  [[nodiscard]] bool has(const std::string& member) const { return json_.contains(member); }
  [[nodiscard]] Result<MappingObject> object(const std::string& member) const {
    if (!has(member)) return fault(member, "is missing");
    return MappingObject(json_.at(member), file_, path_.empty() ? member : path_ + "." + member);
  }
  [[nodiscard]] Result<std::string> text(const std::string& member, std::size_t max_bytes) const {
    const bool is_text = has(member) && json_.at(member).is_string();
    const std::string text = is_text ? json_.at(member).get<std::string>() : std::string();
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    if (text.empty() || text.size() > max_bytes ||
        std::any_of(text.begin(), text.end(), is_control)) {
      return fault(member,
                   "must be a text of 1 to " + std::to_string(max_bytes) +
                       " bytes without control characters");
    }
    return text;
  }
  /// A finite number with a magnitude of at most `limit`.
  [[nodiscard]] Result<double> number(const std::string& member, double limit) const {
    const bool is_number = has(member) && json_.at(member).is_number();
    const double value = is_number ? json_.at(member).get<double>() : std::nan("");
    if (!(std::abs(value) <= limit)) {
      return fault(member,
                   "must be a number in [-" + MappingJson(limit).dump() + ", " +
                       MappingJson(limit).dump() + "]");
    }
    return value;
  }

 private:
  static std::string shown(const MappingJson& value) {
    std::string text = value.dump(-1, ' ', true, MappingJson::error_handler_t::replace);
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
  }

  const MappingJson& json_;
  std::string file_;
  std::string path_;
};

}  // namespace overfly::flight::logs
