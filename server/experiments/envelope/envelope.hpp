// The envelope of an estimator: how far along one axis of a sweep it survives, for all other
// values.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/fly_sweep.hpp"

namespace overfly::server::experiments {

/// What is sought.
struct BorderSearch {
  std::string axis;       ///< name of the axis along which the border is sought
  std::string estimator;  ///< empty = the first one
};

struct EnvelopeOptions {
  SweepOptions flights;  ///< lock and writes_progress are set by find_envelope
  BorderSearch border;
  /// Called with the number of cells flown so far.
  std::function<void(std::size_t)> progress;
};

struct EnvelopeLine {
  nlohmann::json at;                       ///< other axis -> value
  std::optional<nlohmann::json> survives;  ///< last value that survives; empty = none does
  std::optional<nlohmann::json> fails;     ///< next value, which fails; empty = none does
  bool irregular = false;                  ///< survival does not end once
};

struct Envelope {
  std::string axis, label, unit;
  std::string estimator;
  std::vector<EnvelopeLine> lines;
  std::size_t cells_needed = 0;
  std::size_t cells = 0;  ///< of the sweep
};

/// Axes of a sweep along which a border can be sought: in a grid, with at least two values.
[[nodiscard]] std::vector<const SweepAxis*> border_axes(const Sweep& sweep);

/// Whether a border can be sought. Sets an empty estimator to the first one.
/// @param estimators  of the sweep
/// Errors: kInvalidArgument for an axis that is none of border_axes(), an unknown estimator and
/// skipped cells.
[[nodiscard]] Status check_border(const Sweep& sweep,
                                  const std::vector<std::string>& estimators,
                                  BorderSearch& border);

/// Finds the border by bisection, as find_borders. Flies into the folder of the sweep: what is
/// there is not flown again, and `overfly sweep` can fill the rest. A cell survives if at least
/// half of its flights have the outcome COMPLETED. The folder's progress is that of the whole
/// sweep. Errors: as fly_sweep and check_border; kCancelled; kInternal for a cell whose flights
/// failed.
[[nodiscard]] Result<Envelope> find_envelope(const Sweep& sweep, const EnvelopeOptions& options);

/// A table in Markdown.
[[nodiscard]] std::string markdown_from(const Sweep& sweep, const Envelope& envelope);
[[nodiscard]] nlohmann::json json_from(const Envelope& envelope);

/// envelope.json in the folder of a sweep. Errors: kIo.
[[nodiscard]] Status write_envelope(const std::filesystem::path& folder, const Envelope& envelope);
/// Likewise, for one that is not found yet: its `lines` are null.
[[nodiscard]] Status write_border_search(const std::filesystem::path& folder,
                                         const Sweep& sweep,
                                         const BorderSearch& border);
void remove_envelope(const std::filesystem::path& folder);
/// Errors: kNotFound; as read_json; kUnreadable.
[[nodiscard]] Result<nlohmann::json> read_envelope(const std::filesystem::path& folder);

}  // namespace overfly::server::experiments
