#include "core/outside/outside_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

namespace overfly {
namespace {

/// Line and column, both from 1, of a byte offset.
std::string position_of(std::string_view text, std::size_t byte) {
  std::size_t line = 1;
  std::size_t column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    ++column;
    if (text[i] == '\n') {
      ++line;
      column = 1;
    }
  }
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Nesting and number of keys of a JSON text, by its brackets and colons outside strings.
struct Outline {
  bool too_deep = false;
  std::size_t keys = 0;  ///< of all objects together, if it is valid
};

Outline outline_of(std::string_view text) {
  Outline outline;
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == ':') ++outline.keys;
    if (depth > kMaxJsonDepth) {
      outline.too_deep = true;
      break;
    }
  }
  return outline;
}

Error too_deep(const std::string& origin) {
  return {ErrorCode::kUnreadable,
          origin + ": is nested more than " + std::to_string(kMaxJsonDepth) + " deep"};
}

/// The keys of all objects in a value.
template <typename Json>
std::size_t count_keys(const Json& value) {
  if (!value.is_structured()) return 0;
  std::size_t keys = value.is_object() ? value.size() : 0;
  for (const Json& element : value) keys += count_keys(element);
  return keys;
}

/// The path of the first key that its object has twice: "estimators.0.name".
template <typename Json>
std::string repeated_key(std::string_view text) {
  struct Level {
    bool is_object;
    std::set<std::string> keys = {};
    std::string at = {};  ///< key or index of the current element
    std::size_t elements = 0;
  };
  std::vector<Level> levels;
  std::string path;
  const auto next_element = [&] {
    if (levels.empty() || levels.back().is_object) return;
    levels.back().at = std::to_string(levels.back().elements++);
  };
  const auto look = [&](int, typename Json::parse_event_t event, Json& parsed) {
    using Event = typename Json::parse_event_t;
    if (event == Event::object_end || event == Event::array_end) levels.pop_back();
    if (event == Event::value) next_element();
    if (event == Event::object_start || event == Event::array_start) {
      next_element();
      levels.push_back({event == Event::object_start});
    }
    if (event != Event::key) return true;
    levels.back().at = parsed.template get<std::string>();
    if (levels.back().keys.insert(levels.back().at).second || !path.empty()) return true;
    for (const Level& level : levels) path += (path.empty() ? "" : ".") + level.at;
    return true;
  };
  [[maybe_unused]] const Json again = Json::parse(text, look);
  return path;
}

}  // namespace

Status check_json_depth(std::string_view text, const std::string& origin) {
  if (outline_of(text).too_deep) return too_deep(origin);
  return {};
}

Error json_syntax_error(std::string_view text,
                        std::size_t byte,
                        const std::string& complaint,
                        const std::string& origin) {
  const std::size_t cut = complaint.find("syntax error");
  std::string reason = cut == std::string::npos ? complaint : complaint.substr(cut);
  // The parser quotes the last token read, which can have any length.
  constexpr std::size_t kLongest = 200;
  if (reason.size() > kLongest) reason = reason.substr(0, kLongest) + "...";
  return {ErrorCode::kUnreadable, origin + ", " + position_of(text, byte) + ": " + reason};
}

template <typename Json>
Result<Json> json_from_outside(std::string_view text, const std::string& origin) {
  const Outline outline = outline_of(text);
  if (outline.too_deep) return too_deep(origin);
  try {
    Json document = Json::parse(text);
    if (count_keys(document) == outline.keys) return document;
    // The parser keeps the last value.
    return Error{ErrorCode::kUnreadable,
                 origin + ": " + repeated_key<Json>(text) + ": must be given at most once"};
  } catch (const typename Json::parse_error& error) {
    return json_syntax_error(text, error.byte, error.what(), origin);
  } catch (const typename Json::exception& error) {
    // For example a number out of the range of a double.
    return Error{ErrorCode::kUnreadable, origin + ": " + error.what()};
  }
}

template Result<nlohmann::json> json_from_outside(std::string_view, const std::string&);
template Result<nlohmann::ordered_json> json_from_outside(std::string_view, const std::string&);

}  // namespace overfly
