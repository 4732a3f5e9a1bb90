#include "core/outside/outside_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

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

}  // namespace

Status check_json_depth(std::string_view text, const std::string& origin) {
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
    if (depth > kMaxJsonDepth) {
      return Error{ErrorCode::kUnreadable,
                   origin + ": is nested more than " + std::to_string(kMaxJsonDepth) + " deep"};
    }
  }
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
  if (Status status = check_json_depth(text, origin); !status) return status.error();
  try {
    return Json::parse(text);
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
