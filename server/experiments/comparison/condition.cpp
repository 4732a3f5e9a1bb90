#include "server/experiments/comparison/condition.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "evaluation/statistics/sample_quantile.hpp"

namespace overfly::server::experiments {
namespace {

using Node = Condition::Node;
using NodePointer = std::shared_ptr<const Node>;

constexpr const char* kSuccess = "success_rate";

class ConditionParser {
 public:
  explicit ConditionParser(std::string_view text) : text_(text) {}

  Result<NodePointer> sum(int depth = 0) { return chain("+-", depth); }

  std::optional<std::string> comparison() {
    skip_spaces();
    for (const char* sign : {"<=", ">=", "<", ">"}) {
      if (!text_.substr(at_).starts_with(sign)) continue;
      at_ += std::string_view(sign).size();
      return sign;
    }
    return std::nullopt;
  }
  [[nodiscard]] bool ended() {
    skip_spaces();
    return at_ == text_.size();
  }
  [[nodiscard]] Error error(const std::string& wanted) const {
    return {ErrorCode::kInvalidArgument,
            "condition = " + std::string(text_) + ": must have " + wanted + " at position " +
                std::to_string(at_ + 1)};
  }

 private:
  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(char c) {
    skip_spaces();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::string word() {
    skip_spaces();
    const std::size_t begin = at_;
    const auto is_part = [](char c) {
      return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
    };
    while (at_ < text_.size() && is_part(text_[at_])) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  /// Operands joined by these operators, from left to right.
  // NOLINTNEXTLINE(misc-no-recursion): limited by kDeepest
  Result<NodePointer> chain(std::string_view operators, int depth) {
    const bool sums = operators == "+-";
    Result<NodePointer> left = sums ? chain("*/", depth) : factor(depth);
    while (left) {
      const auto sign =
          std::find_if(operators.begin(), operators.end(), [this](char c) { return take(c); });
      if (sign == operators.end()) break;
      const Result<NodePointer> right = sums ? chain("*/", depth) : factor(depth);
      if (!right) return right;
      Node node;
      node.kind = Node::Kind::kOperation;
      node.operation = *sign;
      node.left = *left;
      node.right = *right;
      left = NodePointer(std::make_shared<Node>(std::move(node)));
    }
    return left;
  }

  // NOLINTNEXTLINE(misc-no-recursion): limited by kDeepest
  Result<NodePointer> factor(int depth) {
    constexpr int kDeepest = 20;
    if (depth > kDeepest) return error("at most 20 nested parentheses");
    if (take('(')) {
      Result<NodePointer> inner = sum(depth + 1);
      if (inner && !take(')')) return error("\")\"");
      return inner;
    }
    if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) {
      return number();
    }
    return quantity();
  }

  Result<NodePointer> number() {
    Node node;
    const auto [end, fault] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), node.number);
    if (fault != std::errc()) return error("a number");
    at_ = static_cast<std::size_t>(end - text_.data());
    return NodePointer(std::make_shared<Node>(std::move(node)));
  }

  Result<NodePointer> quantity() {
    constexpr const char* kWanted =
        "a number, success_rate, baseline, median(...), mean(...), min(...) or max(...)";
    const std::size_t begin = at_;
    Node node;
    node.function = word();
    const auto wrong = [&](const std::string& wanted) {
      at_ = begin;
      return error(wanted);
    };
    if (node.function == "baseline") {
      node.kind = Node::Kind::kBaseline;
      return NodePointer(std::make_shared<Node>(std::move(node)));
    }
    node.kind = Node::Kind::kQuantity;
    if (node.function == kSuccess) return NodePointer(std::make_shared<Node>(std::move(node)));
    static const std::vector<std::string> kFunctions{"median", "mean", "min", "max"};
    if (std::find(kFunctions.begin(), kFunctions.end(), node.function) == kFunctions.end()) {
      return wrong(kWanted);
    }
    if (!take('(')) return error("\"(\"");
    node.quantity = word();
    const std::vector<std::string>& known = condition_quantities();
    if (std::find(known.begin(), known.end(), node.quantity) == known.end()) {
      std::string names;
      for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
      return wrong("one of " + names + " in the parentheses");
    }
    if (!take(')')) return error("\")\"");
    return NodePointer(std::make_shared<Node>(std::move(node)));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// The quantities of an expression.
// NOLINTNEXTLINE(misc-no-recursion): as deep as the parsed text, which is limited
void collect(const NodePointer& node, std::vector<const Node*>& quantities, bool& has_baseline) {
  if (node == nullptr) return;
  if (node->kind == Node::Kind::kQuantity) quantities.push_back(node.get());
  has_baseline = has_baseline || node->kind == Node::Kind::kBaseline;
  collect(node->left, quantities, has_baseline);
  collect(node->right, quantities, has_baseline);
}

Result<double> value_of_quantity(const Node& node, const FlightValues& flights) {
  const std::string& name = node.quantity.empty() ? node.function : node.quantity;
  const auto found = flights.find(name);
  if (found == flights.end() || found->second.empty()) {
    return Error{ErrorCode::kInvalidArgument, name + ": no flight has a value"};
  }
  const std::vector<double>& values = found->second;
  if (node.function == "median") return evaluation::sample_quantile(values, 0.5);
  if (node.function == "min") return *std::min_element(values.begin(), values.end());
  if (node.function == "max") return *std::max_element(values.begin(), values.end());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// NOLINTNEXTLINE(misc-no-recursion): as deep as the parsed text, which is limited
Result<double> value_of(const Node& node, const FlightValues& flights, const double* baseline) {
  if (node.kind == Node::Kind::kNumber) return node.number;
  if (node.kind == Node::Kind::kBaseline) return *baseline;
  if (node.kind == Node::Kind::kQuantity) return value_of_quantity(node, flights);
  const Result<double> left = value_of(*node.left, flights, baseline);
  if (!left) return left;
  const Result<double> right = value_of(*node.right, flights, baseline);
  if (!right) return right;
  switch (node.operation) {
    case '+':
      return *left + *right;
    case '-':
      return *left - *right;
    case '*':
      return *left * *right;
    default:
      return *left / *right;
  }
}

}  // namespace

const std::vector<std::string>& condition_quantities() {
  static const std::vector<std::string> names{"position_rmse_m",
                                              "position_rmse_hold_m",
                                              "rotation_rmse_deg",
                                              "position_auc",
                                              "coverage",
                                              "initialised_at_s",
                                              "reset_count"};
  return names;
}

Result<Condition> Condition::parse(const std::string& text) {
  constexpr std::size_t kLongest = 1000;
  if (text.size() > kLongest) {
    return Error{ErrorCode::kInvalidArgument, "condition: must have at most 1000 characters"};
  }
  Condition condition;
  condition.text_ = text;
  ConditionParser parser(condition.text_);
  Result<NodePointer> left = parser.sum();
  if (!left) return left.error();
  const std::optional<std::string> comparison = parser.comparison();
  if (!comparison) return parser.error("<, <=, > or >=");
  Result<NodePointer> right = parser.sum();
  if (!right) return right.error();
  if (!parser.ended()) return parser.error("its end");
  condition.comparison_ = *comparison;
  condition.left_ = *left;
  condition.right_ = *right;
  std::vector<const Node*> of_left;
  std::vector<const Node*> of_right;
  bool left_baseline = false;
  bool right_baseline = false;
  collect(condition.left_, of_left, left_baseline);
  collect(condition.right_, of_right, right_baseline);
  if (left_baseline || (right_baseline && of_left.size() != 1)) {
    return Error{ErrorCode::kInvalidArgument,
                 "condition = " + text +
                     ": baseline must be on the right of one quantity, which it stands for"};
  }
  return condition;
}

Result<Condition::Verdict> Condition::evaluate(const FlightValues& flights,
                                               const FlightValues& baseline) const {
  std::vector<const Node*> quantities;
  std::vector<const Node*> unused;
  bool needs_baseline = false;
  collect(left_, quantities, needs_baseline);
  collect(right_, unused, needs_baseline);
  double reference = 0.0;
  if (needs_baseline) {
    const Result<double> value = value_of_quantity(*quantities.front(), baseline);
    if (!value) return value.error().in("baseline");
    reference = *value;
  }
  const Result<double> left = value_of(*left_, flights, &reference);
  if (!left) return left.error();
  const Result<double> right = value_of(*right_, flights, &reference);
  if (!right) return right.error();
  if (!std::isfinite(*left) || !std::isfinite(*right)) {
    return Error{ErrorCode::kInvalidArgument, "condition = " + text_ + ": gives no finite number"};
  }
  const bool less = comparison_.front() == '<';
  const bool equal = comparison_.size() == 2 && *left == *right;
  return Verdict{(less ? *left < *right : *left > *right) || equal, *left, *right};
}

}  // namespace overfly::server::experiments
