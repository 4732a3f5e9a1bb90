#include "server/files/json_schema_values.hpp"

#include <algorithm>
#include <cmath>

#include "core/text/pattern.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

std::string with_article(const std::string& type) {
  if (type == "string") return "text";
  if (type == "boolean") return "true or false";
  if (type == "null") return "null";
  return (type == "object" || type == "array" || type == "integer" ? "an " : "a ") + type;
}

/// Number of characters (code points) of UTF-8 text, as the standard counts them.
std::size_t length_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string interval_text(const Json& node) {
  const bool open_below = node.contains("exclusiveMinimum");
  const bool open_above = node.contains("exclusiveMaximum");
  const bool below = open_below || node.contains("minimum");
  const bool above = open_above || node.contains("maximum");
  const std::string low = below ? node.at(open_below ? "exclusiveMinimum" : "minimum").dump() : "";
  const std::string high = above ? node.at(open_above ? "exclusiveMaximum" : "maximum").dump() : "";
  if (below && above) {
    return "in " + std::string(open_below ? "(" : "[") + low + ", " + high +
           (open_above ? ")" : "]");
  }
  if (below) return (open_below ? "greater than " : "at least ") + low;
  return (open_above ? "less than " : "at most ") + high;
}

std::string broken_number(const Json& node, const Json& value) {
  const bool inside = (!node.contains("minimum") || value >= node.at("minimum")) &&
                      (!node.contains("maximum") || value <= node.at("maximum")) &&
                      (!node.contains("exclusiveMinimum") || value > node.at("exclusiveMinimum")) &&
                      (!node.contains("exclusiveMaximum") || value < node.at("exclusiveMaximum"));
  return inside ? "" : interval_text(node);
}

std::string broken_text(const Json& node, const std::string& value) {
  const std::size_t length = length_of(value);
  if (node.contains("minLength") && length < node.at("minLength").get<std::size_t>()) {
    return "at least " + node.at("minLength").dump() + " characters long";
  }
  if (node.contains("maxLength") && length > node.at("maxLength").get<std::size_t>()) {
    return "at most " + node.at("maxLength").dump() + " characters long";
  }
  if (node.contains("pattern")) {
    const std::string pattern = node.at("pattern").get<std::string>();
    if (!contains_pattern(value, pattern)) {
      return "text that matches " + pattern;
    }
  }
  return "";
}

std::string broken_size(const Json& node, std::size_t size, const char* least, const char* most) {
  if (node.contains(least) && size < node.at(least).get<std::size_t>()) {
    return "at least " + node.at(least).dump() + " of them";
  }
  if (node.contains(most) && size > node.at(most).get<std::size_t>()) {
    return "at most " + node.at(most).dump() + " of them";
  }
  return "";
}

std::string one_of_text(const Json& values) {
  std::string text;
  for (const Json& value : values) text += (text.empty() ? "" : ", ") + value.dump();
  return "one of " + text;
}

}  // namespace

bool has_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  if (type == "number") return value.is_number();
  if (value.is_number_float()) {
    const double number = value.get<double>();
    return std::trunc(number) == number;
  }
  return value.is_number_integer();
}

std::string broken_limit(const Json& node, const Json& value) {
  if (node.contains("type")) {
    const std::string type = node.at("type").get<std::string>();
    if (!has_type(value, type)) return with_article(type);
  }
  if (node.contains("const") && value != node.at("const")) return node.at("const").dump();
  if (node.contains("enum")) {
    const Json& allowed = node.at("enum");
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
      return one_of_text(allowed);
    }
  }
  if (value.is_number()) return broken_number(node, value);
  if (value.is_string()) return broken_text(node, value.get<std::string>());
  if (value.is_array()) return broken_size(node, value.size(), "minItems", "maxItems");
  if (value.is_object()) return broken_size(node, value.size(), "minProperties", "maxProperties");
  return "";
}

std::string shown(const Json& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest - 3) + "...";
  return text;
}

std::string label_of(const std::string& path) { return path.empty() ? "the document" : path; }

}  // namespace overfly::server
