// The run and the estimator that are explained.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server::experiments {

struct ExplainedRun {
  std::filesystem::path folder;
  std::string id;
  std::string title;
  nlohmann::json document;  ///< resolved scenario
  std::string estimator_name;
  std::size_t estimator = 0;  ///< index in the scenario
  double duration_s = 0.0;
  evaluation::Score score;  ///< of the estimator
};

/// @param estimator  empty: the first one that failed, else the first
/// Errors: kInvalidArgument for an unknown estimator, a run that is not completed, and one with
/// recorded images; as read_run_info, read_run_metrics and load_scenario.
[[nodiscard]] Result<ExplainedRun> read_explained_run(const std::filesystem::path& run_folder,
                                                      const std::string& estimator,
                                                      const SourcePolicy& sources);

}  // namespace overfly::server::experiments
