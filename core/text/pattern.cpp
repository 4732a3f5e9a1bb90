#include "core/text/pattern.hpp"

#include <map>
#include <mutex>
#include <regex>
#include <utility>

namespace overfly {
namespace {

const std::regex& compiled_pattern(const std::string& pattern, LetterCase letter_case) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, LetterCase>, std::regex> patterns;
  const std::scoped_lock lock(mutex);
  const auto key = std::pair(pattern, letter_case);
  const auto found = patterns.find(key);
  if (found != patterns.end()) return found->second;
  const auto flags = letter_case == LetterCase::kAny ? std::regex::icase : std::regex::flag_type{};
  return patterns.emplace(key, std::regex(pattern, std::regex::ECMAScript | flags)).first->second;
}

}  // namespace

bool matches_pattern(const std::string& text, const std::string& pattern, LetterCase letter_case) {
  return std::regex_match(text, compiled_pattern(pattern, letter_case));
}

bool contains_pattern(const std::string& text, const std::string& pattern) {
  return std::regex_search(text, compiled_pattern(pattern, LetterCase::kExact));
}

}  // namespace overfly
