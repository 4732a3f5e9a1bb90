// Errors that somebody has published for the cells of a sweep, to be shown next to one's own.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/tables/cell_scores.hpp"

namespace overfly::server::experiments {

struct PublishedCell {
  nlohmann::json cell;  ///< axis name -> value
  /// By PublishedErrors::estimators; empty for an X.
  std::vector<std::optional<double>> position_m;
  std::vector<std::optional<double>> rotation_deg;
};

struct PublishedErrors {
  std::string source;
  std::vector<std::string> estimators;
  std::vector<PublishedCell> cells;

  /// The row whose values a cell of a sweep has; the cell may have further axes. Null if none.
  [[nodiscard]] const PublishedCell* find(const nlohmann::json& cell) const;
  /// Index of an estimator; empty if it has none of this name.
  [[nodiscard]] std::optional<std::size_t> index_of(const std::string& estimator) const;
};

/// Errors: as read_json; kInvalidArgument naming the field that is wrong.
[[nodiscard]] Result<PublishedErrors> read_published_errors(const std::filesystem::path& file);

/// How often two estimators are in the same order here and there.
struct OrderingAgreement {
  std::string first;             ///< published name
  std::string second;            ///< published name
  std::string quantity;          ///< "position_m" or "rotation_deg"
  std::size_t cells = 0;         ///< in which both have a value here and there
  std::size_t same = 0;          ///< of these, in the same order
  std::size_t first_better = 0;  ///< of these, the first is better as published
};

/// Of all pairs of published estimators with counterparts.
/// @param counterparts  estimator of the sweep -> published name
[[nodiscard]] std::vector<OrderingAgreement> ordering_agreements(
    const std::vector<CellScores>& rows,
    std::size_t convention,
    const PublishedErrors& published,
    const std::map<std::string, std::string>& counterparts);

}  // namespace overfly::server::experiments
