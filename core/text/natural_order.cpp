#include "core/text/natural_order.hpp"

namespace overfly {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns the digits at `begin` without leading zeros; moves `begin` past them.
std::string number_at(const std::string& text, std::size_t& begin) {
  while (begin < text.size() && text[begin] == '0') ++begin;
  const std::size_t first = begin;
  while (begin < text.size() && is_digit(text[begin])) ++begin;
  return text.substr(first, begin - first);
}

}  // namespace

bool before_naturally(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string number_a = number_at(a, i);
      const std::string number_b = number_at(b, j);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
      continue;
    }
    if (a[i] != b[j]) return a[i] < b[j];
    ++i;
    ++j;
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a < b;
}

}  // namespace overfly
