// Hunt files (scenarios/hunt.schema.json): the limits within which the worst flight is searched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/hunt/point_search.hpp"
#include "server/experiments/hunt/survival_margin.hpp"
#include "server/experiments/sweep_document.hpp"

namespace overfly::server::experiments {

struct Hunt {
  /// Base scenario, axes, changes, estimator, repeats, time limit. Its cells are the points flown.
  Sweep sweep;
  std::string estimator;  ///< its name
  SearchMethod method = SearchMethod::kModel;
  bool stop_at_failure = true;
  std::size_t most_flights = 60;
  std::size_t batch = 1;  ///< points that are chosen together
  std::uint64_t seed = 1;
  MarginRule rule;
};

/// What the flights of a hunt may name and do.
struct HuntLimits {
  SourcePolicy sources;
  /// Further check of every flight's scenario; may be empty.
  std::function<Status(const Scenario&)> check;
};

/// The JSON schema of hunt files as text, embedded in the program.
[[nodiscard]] const std::string& hunt_schema_text();

/// "PATH=FROM:TO" or "PATH=FROM:TO:STEP" as an axis of a document. Errors: kInvalidArgument.
[[nodiscard]] Result<nlohmann::json> parse_axis(const std::string& text);

/// The document of a hunt: that of a hunt file, or one that names a scenario file. Absent fields
/// stay absent.
/// Errors: as read_json; kUnreadable if it is no object.
[[nodiscard]] Result<nlohmann::json> read_hunt_document(const std::filesystem::path& file);

/// @param folder  of a relative `scenario`
/// @param estimator  of the base scenario; empty = its first one. Must be empty if the document has
/// an estimator of its own.
/// Errors: kInvalidArgument with each invalid field as "field = value: must be limit", one a line;
/// as load_scenario and HuntLimits::check for the middle and for each corner of the axes;
/// kUnsupported for scenarios that are flown by a live vehicle.
[[nodiscard]] Result<Hunt> resolve_hunt(nlohmann::json document,
                                        const std::filesystem::path& folder,
                                        const std::string& estimator,
                                        const HuntLimits& limits = {});

/// The axes as the search sees them.
[[nodiscard]] std::vector<SearchAxis> search_axes(const Hunt& hunt);
/// The flight at a point of the search.
[[nodiscard]] SweepCell cell_at(const Hunt& hunt, const Eigen::VectorXd& point);

}  // namespace overfly::server::experiments
