// Reads HTML and SVG as strictly as XML: what a report contains, independent of how it is written.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace overfly::server::report::testing {

struct Element {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< references resolved
  std::string text;  ///< of the element itself, not of those in it; references resolved

  /// Empty if it has none.
  [[nodiscard]] std::string attribute(const std::string& key) const;
};

struct Markup {
  std::vector<Element> elements;  ///< in the order of their start
  std::string fault;              ///< why it is not well formed; empty if it is

  [[nodiscard]] std::vector<Element> named(const std::string& name) const;
};

/// Every element has its end tag but HTML's void ones; attributes are quoted; no stray `<` or `&`.
[[nodiscard]] Markup read_markup(const std::string& text);

}  // namespace overfly::server::report::testing
