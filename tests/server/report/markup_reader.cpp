#include "tests/server/report/markup_reader.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace overfly::server::report::testing {
namespace {

bool is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == ':';
}

class MarkupReader {
 public:
  explicit MarkupReader(const std::string& text) : text_(text) {}

  Markup read() {
    while (at_ < text_.size() && markup_.fault.empty()) {
      if (text_[at_] != '<') {
        take_text();
      } else if (text_.compare(at_, 2, "</") == 0) {
        take_end();
      } else if (text_.compare(at_, 2, "<!") == 0) {
        at_ = text_.find('>', at_) + 1;
      } else {
        take_start();
      }
    }
    if (!open_.empty()) fail("not closed: " + markup_.elements[open_.back()].name);
    return markup_;
  }

 private:
  void fail(const std::string& why) {
    if (!markup_.fault.empty()) return;
    markup_.fault = why + " at byte " + std::to_string(at_) + ": " + text_.substr(at_, 60);
    at_ = text_.size();
  }

  std::string resolved(const std::string& raw) {
    static const std::map<std::string, char> kReferences = {
        {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}};
    std::string text;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      if (raw[i] == '<') fail("a < in a text");
      if (raw[i] != '&') {
        text += raw[i];
        continue;
      }
      const std::size_t end = raw.find(';', i);
      const auto known = kReferences.find(raw.substr(i, end - i + 1));
      if (known == kReferences.end()) {
        fail("an unknown reference");
        return text;
      }
      text += known->second;
      i = end;
    }
    return text;
  }

  void take_text() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    const std::string text = resolved(text_.substr(at_, end - at_));
    if (!open_.empty()) markup_.elements[open_.back()].text += text;
    at_ = std::max(at_, end);
  }

  void take_end() {
    const std::size_t end = text_.find('>', at_);
    const std::string name = text_.substr(at_ + 2, end - at_ - 2);
    if (open_.empty() || markup_.elements[open_.back()].name != name) {
      fail("an end tag of another element");
      return;
    }
    open_.pop_back();
    at_ = end + 1;
  }

  std::string take_name() {
    std::string name;
    while (at_ < text_.size() && is_name(text_[at_])) name += text_[at_++];
    if (name.empty()) fail("a name is missing");
    return name;
  }

  void take_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }

  void take_attribute(Element& element) {
    const std::string key = take_name();
    if (text_.compare(at_, 2, "=\"") != 0) {
      fail("an attribute without quoted value");
      return;
    }
    const std::size_t end = text_.find('"', at_ + 2);
    element.attributes.emplace_back(key, resolved(text_.substr(at_ + 2, end - at_ - 2)));
    at_ = std::max(at_, end + 1);
  }

  void take_start() {
    static const std::set<std::string> kVoid = {"meta", "br", "hr", "link", "img", "input"};
    ++at_;
    Element element;
    element.name = take_name();
    take_spaces();
    while (at_ < text_.size() && text_[at_] != '>' && text_[at_] != '/') {
      take_attribute(element);
      take_spaces();
    }
    const bool ended = at_ < text_.size() && text_[at_] == '/';
    at_ += ended ? 2 : 1;
    markup_.elements.push_back(element);
    if (ended || kVoid.count(element.name) > 0) return;
    open_.push_back(markup_.elements.size() - 1);
    // Their content is text as it is, up to the end tag.
    if (element.name != "script" && element.name != "style") return;
    const std::size_t end = text_.find("</", at_);
    markup_.elements.back().text = text_.substr(at_, end - at_);
    at_ = end;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  Markup markup_;
  std::vector<std::size_t> open_;  ///< indices of elements without end tag yet
};

}  // namespace

std::string Element::attribute(const std::string& key) const {
  for (const auto& [known, value] : attributes) {
    if (known == key) return value;
  }
  return "";
}

std::vector<Element> Markup::named(const std::string& name) const {
  std::vector<Element> found;
  for (const Element& element : elements) {
    if (element.name == name) found.push_back(element);
  }
  return found;
}

Markup read_markup(const std::string& text) { return MarkupReader(text).read(); }

}  // namespace overfly::server::report::testing
