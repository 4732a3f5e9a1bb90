#include "server/scenario/document/scenario_override.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/outside/outside_json.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Error bad_path(const std::string& path, const std::string& why) {
  return {ErrorCode::kInvalidArgument, "override \"" + path + "\": " + why};
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', begin)) {
    parts.push_back(path.substr(begin, dot - begin));
    begin = dot + 1;
  }
  parts.push_back(path.substr(begin));
  return parts;
}

std::optional<std::size_t> index_from(const std::string& text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return index;
}

/// A world or a flight is of exactly one kind, so setting another kind replaces it; likewise for
/// `camera` and `cameras`.
void make_room_for_kind(Json& document, const std::vector<std::string>& parts) {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> kinds = {
      {"world", {"builtin", "manifest", "imagery"}},
      {"flight", {"course", "log", "mavlink", "ros", "mission", "run"}}};
  // A document has either `camera` or `cameras`: setting the whole of one removes the other.
  if (parts.size() == 1 && parts[0] == "cameras") document.erase("camera");
  if (parts.size() == 1 && parts[0] == "camera") document.erase("cameras");
  if (parts.size() < 2) return;
  for (const auto& [field, names] : kinds) {
    if (parts[0] != field || !document.contains(field) || !document[field].is_object()) continue;
    const bool names_kind = std::find(names.begin(), names.end(), parts[1]) != names.end();
    if (names_kind && !document[field].contains(parts[1])) document[field] = Json::object();
  }
}

}  // namespace

Result<Override> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Error{ErrorCode::kInvalidArgument, text.substr(0, 100) + ": must be path=value"};
  }
  Override change;
  change.path = text.substr(0, equals);
  const std::string value = text.substr(equals + 1);
  if (Status status = check_json_depth(value, change.path); !status) {
    return Error{ErrorCode::kInvalidArgument, status.error().message};
  }
  Result<Json> json = json_from_outside<Json>(value, change.path);
  // An object or list with a mistake is not meant as text.
  if (!json && (value.starts_with('{') || value.starts_with('['))) {
    return Error{ErrorCode::kInvalidArgument, json.error().message};
  }
  change.value = json ? std::move(*json) : Json(value);
  return change;
}

Result<std::vector<Override>> parse_overrides(const std::vector<std::string>& texts) {
  std::vector<Override> changes;
  for (const std::string& text : texts) {
    Result<Override> change = parse_override(text);
    if (!change) return change.error().in("--set");
    changes.push_back(std::move(*change));
  }
  return changes;
}

Status apply_override(const Override& change, Json& document) {
  const auto dots = std::count(change.path.begin(), change.path.end(), '.');
  if (static_cast<std::size_t>(dots) >= kMaxJsonDepth) {
    return bad_path(change.path.substr(0, 60) + "...",
                    "has " + std::to_string(dots + 1) + " parts: must have at most " +
                        std::to_string(kMaxJsonDepth));
  }
  const std::vector<std::string> parts = split(change.path);
  if (!document.is_object()) return bad_path(change.path, "the document is not an object");
  make_room_for_kind(document, parts);
  Json* place = &document;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string& part = parts[i];
    // A missing part becomes an array if the path continues with a number.
    const bool array_next = i + 1 < parts.size() && index_from(parts[i + 1]).has_value();
    const Json made = array_next ? Json::array() : Json::object();
    if (part.empty()) return bad_path(change.path, "has an empty part");
    if (place->is_array()) {
      const std::optional<std::size_t> index = index_from(part);
      if (!index || *index > place->size()) {
        return bad_path(
            change.path,
            "\"" + part + "\": must be a number in [0, " + std::to_string(place->size()) + "]");
      }
      if (*index == place->size()) place->push_back(made);
      place = &(*place)[*index];
    } else if (place->is_object()) {
      if (!place->contains(part)) (*place)[part] = made;
      place = &(*place)[part];
    } else {
      return bad_path(change.path, "\"" + part + "\": its parent is not an object or array");
    }
  }
  *place = change.value;
  return {};
}

}  // namespace overfly::server
