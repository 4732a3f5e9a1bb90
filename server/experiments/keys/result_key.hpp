// What decides a flight's result, as keys: equal keys mean equal results in lockstep.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "server/scenario/scenario.hpp"

namespace overfly::server::experiments {

/// Digest of a scenario without its names, its texts and its estimators, of the files that it names
/// and may name (those up to 1 MiB by content, larger ones by size and modification time; also the
/// files named by a world's manifest), and of the program.
[[nodiscard]] std::string flight_key(const Scenario& scenario);

/// Digest of a flight and of one of its estimators, as the scenario's document describes it, with
/// the files that it names (a vocabulary), its program_files and its script_modules. What an
/// estimator behind LCM or ROS consists of is not known.
[[nodiscard]] std::string result_key(const std::string& flight, const nlohmann::json& estimator);

}  // namespace overfly::server::experiments
