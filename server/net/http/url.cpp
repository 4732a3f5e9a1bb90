#include "server/net/http/url.hpp"

#include <algorithm>
#include <cstddef>

namespace overfly::net {
namespace {

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool parse_query(std::string_view text, Url* url) {
  for (const std::string_view part : split(text, '&')) {
    if (part.empty()) continue;
    const std::size_t equals = std::min(part.find('='), part.size());
    const auto name = percent_decode(part.substr(0, equals), true);
    const auto value =
        percent_decode(equals < part.size() ? part.substr(equals + 1) : std::string_view(), true);
    if (!name || !value) return false;
    if (!url->query.insert_or_assign(*name, *value).second) url->repeated = *name;
  }
  return true;
}

}  // namespace

std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const auto high = hex_digit(text[i + 1]);
      const auto low = hex_digit(text[i + 2]);
      if (!high || !low) return std::nullopt;
      c = static_cast<char>(*high * 16 + *low);
      i += 2;
    } else if (c == '+' && plus_is_space) {
      c = ' ';
    }
    if (c == '\0') return std::nullopt;
    decoded.push_back(c);
  }
  return decoded;
}

std::optional<std::string> take_query_parameter(std::string* target, std::string_view name) {
  const std::size_t question = target->find('?');
  if (question == std::string::npos) return std::nullopt;
  std::optional<std::string> value;
  std::string rest;
  for (const std::string_view part : split(std::string_view(*target).substr(question + 1), '&')) {
    const std::size_t equals = std::min(part.find('='), part.size());
    if (percent_decode(part.substr(0, equals), true) == name) {
      const auto text = part.substr(std::min(equals + 1, part.size()));
      value = percent_decode(text, true).value_or("");
    } else if (!part.empty()) {
      rest.append(rest.empty() ? "?" : "&").append(part);
    }
  }
  if (value) target->replace(question, std::string::npos, rest);
  return value;
}

std::optional<Url> parse_target(std::string_view target) {
  if (target.empty() || target.front() != '/') return std::nullopt;
  Url url;
  const std::size_t fragment = target.find('#');
  target = target.substr(0, fragment);
  const std::size_t question = std::min(target.find('?'), target.size());
  if (question < target.size() && !parse_query(target.substr(question + 1), &url)) {
    return std::nullopt;
  }
  const std::string_view path = target.substr(1, question - 1);
  if (path.empty()) return url;
  for (const std::string_view part : split(path, '/')) {
    const auto segment = percent_decode(part, false);
    if (!segment) return std::nullopt;
    url.segments.push_back(*segment);
  }
  return url;
}

}  // namespace overfly::net
