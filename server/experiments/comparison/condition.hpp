// Conditions on the results of two sets of flights: "median(position_rmse_m) > 1.1 * baseline".
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server::experiments {

/// Values of a set of flights: name of a quantity -> one value for each flight that has it.
using FlightValues = std::map<std::string, std::vector<double>>;

/// The quantities that a condition may name in addition to `success_rate`.
[[nodiscard]] const std::vector<std::string>& condition_quantities();

/// A parsed condition. Grammar:
///
///     condition = sum ("<" | "<=" | ">" | ">=") sum
///     sum       = product {("+" | "-") product}
///     product   = factor {("*" | "/") factor}
///     factor    = NUMBER | "(" sum ")" | "success_rate" | "baseline"
///               | ("median" | "mean" | "min" | "max") "(" QUANTITY ")"
///
/// `baseline` is the one quantity of the condition's left side, of the other set of flights.
class Condition {
 public:
  /// Errors: kInvalidArgument naming the text and the position.
  [[nodiscard]] static Result<Condition> parse(const std::string& text);

  struct Verdict {
    bool holds = false;
    double left = 0.0;
    double right = 0.0;
  };
  /// Errors: kInvalidArgument if a quantity has no value in one of the sets, and for a result that
  /// is no finite number.
  [[nodiscard]] Result<Verdict> evaluate(const FlightValues& flights,
                                         const FlightValues& baseline) const;
  [[nodiscard]] const std::string& text() const { return text_; }

  /// A node of the parsed expression.
  struct Node {
    enum class Kind { kNumber, kQuantity, kBaseline, kOperation } kind = Kind::kNumber;
    double number = 0.0;
    std::string function;  ///< of a quantity: "median", ..., or "success_rate"
    std::string quantity;
    char operation = '+';
    std::shared_ptr<const Node> left;
    std::shared_ptr<const Node> right;
  };

 private:
  std::string text_;
  std::string comparison_;
  std::shared_ptr<const Node> left_;
  std::shared_ptr<const Node> right_;
};

}  // namespace overfly::server::experiments
