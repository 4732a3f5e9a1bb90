// Sweep files (scenarios/sweep.schema.json): which flights of a base scenario are flown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server::experiments {

/// Maximum number of cells of a sweep.
inline constexpr std::size_t kMaxCells = 10'000;
/// Maximum size of the values of all cells together, as text.
inline constexpr std::size_t kMaxCellsBytes = std::size_t{64} << 20U;
/// Maximum size of a sweep file.
inline constexpr std::uint64_t kMaxSweepBytes = std::uint64_t{4} << 20U;

struct AxisValue {
  nlohmann::json value;  ///< as shown: a number, a text, ...
  std::vector<Override> changes;
};

struct SweepAxis {
  std::string name;   ///< dotted path of a scenario's field, or the name of an axis of variants
  std::string label;  ///< for people
  std::string unit;
  std::vector<AxisValue> values;  ///< empty for a range without steps
  /// Limits of a range; values between them are drawn by a Latin hypercube.
  std::optional<std::pair<double, double>> range;
};

/// One point of the axes.
struct SweepCell {
  nlohmann::json values;  ///< axis name -> value, in the order of the axes' names
  std::vector<Override> changes;
};

struct RepeatRule {
  int most = 1;
  /// Stop when Wilson's 95 % interval of the success rate has at most this half-width.
  std::optional<double> half_width;
  bool vary_world = false;
  double vary_start_s = 0.0;  ///< repeats start at instants spread over so many seconds
};

struct LatinHypercube {
  std::size_t cells = 1;
  std::uint64_t seed = 1;
};

struct Sweep {
  std::string title;
  std::filesystem::path scenario_file;
  std::vector<Override> changes;  ///< of every flight
  std::vector<SweepAxis> axes;
  std::optional<LatinHypercube> latin_hypercube;
  /// Points that were chosen otherwise, instead of the grid of the axes.
  std::optional<std::vector<SweepCell>> chosen_cells;
  std::vector<nlohmann::json> skip;  ///< axis name -> value, or {"min", "max"}
  RepeatRule repeats;
  double timeout_s = 3600.0;
  int retries = 1;
  nlohmann::json document;  ///< as read, with defaults
  SourcePolicy sources;     ///< files that its scenarios may name
  /// Further check of every flight's scenario; may be empty.
  std::function<Status(const Scenario&)> check;
};

/// The JSON schema of sweep files as text, embedded in the program.
[[nodiscard]] const std::string& sweep_schema_text();

/// Errors: as read_json; kInvalidArgument with each invalid field as "field = value: must be
/// limit", one a line, with the file.
[[nodiscard]] Result<Sweep> load_sweep(const std::filesystem::path& file);

/// As load_sweep, for a document in memory; `folder` is that of a relative `scenario`.
[[nodiscard]] Result<Sweep> resolve_sweep(nlohmann::json document,
                                          const std::filesystem::path& folder);

/// The cells in the order of the axes, the last axis changing fastest, without those to be skipped.
/// Errors: kInvalidArgument for more than kMaxCells or kMaxCellsBytes, a range without step in a
/// grid, a `skip` with an unknown axis, and if no cell is left.
[[nodiscard]] Result<std::vector<SweepCell>> cells_of(const Sweep& sweep);

/// Whether a cell with these values (of the axes by name) is one of those to be skipped.
/// @param skip  as Sweep::skip, checked
[[nodiscard]] bool is_skipped(const std::vector<nlohmann::json>& skip,
                              const nlohmann::json& values);

/// Highest rate of the estimators' debug images in a sweep that does not name
/// `recording.debug_hz` [Hz].
inline constexpr double kSweepDebugHz = 0.5;

/// The scenario of one flight: the seed increases by one with each repeat. With
/// repeats.vary_start_s the start of repeat k is later by the fractional part of k times the golden
/// ratio, times that length: a sequence that is spread evenly however many repeats are flown.
/// Errors: as load_scenario, check_scenario and Sweep::check; kInvalidArgument for
/// repeats.vary_world with another world than the built-in one. Each names the cell.
[[nodiscard]] Result<Scenario> scenario_of(const Sweep& sweep, const SweepCell& cell, int repeat);

/// "flight.course.height_agl_m = 50, seed = 2"
[[nodiscard]] std::string cell_text(const nlohmann::json& values);

}  // namespace overfly::server::experiments
