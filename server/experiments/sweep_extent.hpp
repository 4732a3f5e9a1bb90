// Which flights a sweep has, as sweep.json tells: its folder may have results of others, which were
// flown before the sweep was changed.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/experiments/sweep_results.hpp"

namespace overfly::server::experiments {

class SweepExtent {
 public:
  /// What the document of a sweep.json lacks is no limit: then every result belongs to it.
  explicit SweepExtent(const nlohmann::json& sweep);

  /// Whether the sweep has its cell, repeat and estimator.
  [[nodiscard]] bool contains(const SweepResult& result) const;
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }

 private:
  [[nodiscard]] bool has_cell(const nlohmann::json& cell) const;

  std::vector<std::string> estimators_;
  std::optional<std::map<std::string, std::set<nlohmann::json>>> axis_values_;
  std::vector<nlohmann::json> skip_;
  std::optional<std::int64_t> most_repeats_;
};

}  // namespace overfly::server::experiments
