#include "server/experiments/envelope/envelope.hpp"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "server/experiments/envelope/border_search.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMostShown = 100;  ///< characters of a wrong name
constexpr std::size_t kMaxEnvelopeBytes = std::size_t{4} << 20U;

Error invalid(const std::string& text) { return {ErrorCode::kInvalidArgument, text}; }

std::string shown(const Json& value, const std::string& unit) {
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  return unit.empty() ? text : text + " " + unit;
}

/// The sweep's cells as lines along one axis.
struct Grid {
  std::vector<GridLine> lines;
  std::vector<Json> at;  ///< of each line: other axis -> value
  /// By line, then along the axis.
  std::vector<std::vector<const SweepCell*>> cells;
};

std::size_t index_of(const SweepAxis& axis, const Json& value) {
  const auto found = std::find_if(axis.values.begin(),
                                  axis.values.end(),
                                  [&](const AxisValue& known) { return known.value == value; });
  return static_cast<std::size_t>(found - axis.values.begin());
}

Result<Grid> grid_of(const Sweep& sweep,
                     const std::vector<SweepCell>& cells,
                     const SweepAxis& along) {
  Grid grid;
  std::map<std::vector<std::size_t>, std::size_t> known;
  for (const SweepCell& cell : cells) {
    GridLine line;
    Json at = Json::object();
    for (const SweepAxis& axis : sweep.axes) {
      if (axis.name == along.name) continue;
      at[axis.name] = cell.values.at(axis.name);
      line.at.push_back(index_of(axis, at[axis.name]));
    }
    const auto [place, is_new] = known.try_emplace(line.at, grid.lines.size());
    if (is_new) {
      grid.lines.push_back(std::move(line));
      grid.at.push_back(std::move(at));
      grid.cells.emplace_back(along.values.size(), nullptr);
    }
    grid.cells[place->second][index_of(along, cell.values.at(along.name))] = &cell;
  }
  for (const auto& line : grid.cells) {
    if (std::find(line.begin(), line.end(), nullptr) != line.end()) {
      return invalid("skip: must leave out no cell, because the border may lie there");
    }
  }
  return grid;
}

/// Whether at least half of a cell's flights survived.
Result<bool> survived(const FlownSweep& flown, std::size_t cell, const std::string& estimator) {
  int flights = 0;
  int successes = 0;
  std::string failure = "was not flown";
  for (const SweepResult* result : flown.plan.results_of(cell, estimator, flown.results)) {
    if (result == nullptr) continue;
    if (!result->completed()) {
      failure = result->error;
      continue;
    }
    ++flights;
    successes += result->outcome == evaluation::Outcome::kCompleted ? 1 : 0;
  }
  if (flights == 0) {
    return Error{ErrorCode::kInternal, cell_text(flown.plan.cells()[cell].values) + ": " + failure};
  }
  return 2 * successes >= flights;
}

Result<const SweepAxis*> axis_along(const Sweep& sweep, const std::string& name) {
  std::string names;
  for (const SweepAxis* axis : border_axes(sweep)) {
    if (axis->name == name) return axis;
    names += (names.empty() ? "" : ", ") + axis->name;
  }
  const std::string wanted = name.substr(0, kMostShown);
  if (names.empty()) {
    return invalid("border.axis = " + wanted +
                   ": the sweep has no axis with at least two values, in a grid without a Latin "
                   "hypercube");
  }
  return invalid("border.axis = " + wanted +
                 ": must be an axis of the sweep with at least two values (" + names + ")");
}

/// How much of the whole sweep is flown. For those who watch the folder: errors are noticed where
/// results are written.
/// @param now  of the cells that were flown last
void write_whole_progress(const Sweep& sweep,
                          const SweepOptions& flights,
                          const SweepProgress& now) {
  const Result<FlownSweep> whole = read_sweep(sweep, flights.folder, flights.cancel);
  if (!whole) return;
  SweepProgress progress = now;
  progress.passed = whole->progress.passed;
  progress.most = whole->progress.most;
  progress.left_s.reset();
  (void)write_progress(flights.folder, progress);
}

bool is_line(const Json& line) {
  return line.is_object() && line.contains("at") && line["at"].is_object() &&
         line.contains("survives") && line.contains("fails") && line.contains("irregular") &&
         line["irregular"].is_boolean();
}

/// @pre it is an object
bool is_envelope(const Json& document) {
  for (const char* name : {"axis", "label", "unit", "estimator"}) {
    if (!document.contains(name) || !document[name].is_string()) return false;
  }
  for (const char* name : {"cells", "cells_needed"}) {
    if (!document.contains(name) || !document[name].is_number_unsigned()) return false;
  }
  if (!document.contains("lines")) return false;
  const Json& lines = document["lines"];
  return lines.is_null() || (lines.is_array() && std::all_of(lines.begin(), lines.end(), is_line));
}

fs::path envelope_file(const fs::path& folder) { return folder / "envelope.json"; }

}  // namespace

std::vector<const SweepAxis*> border_axes(const Sweep& sweep) {
  std::vector<const SweepAxis*> axes;
  if (sweep.latin_hypercube) return axes;
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.values.size() >= 2) axes.push_back(&axis);
  }
  return axes;
}

Status check_border(const Sweep& sweep,
                    const std::vector<std::string>& estimators,
                    BorderSearch& border) {
  const Result<const SweepAxis*> along = axis_along(sweep, border.axis);
  if (!along) return along.error();
  if (border.estimator.empty() && !estimators.empty()) border.estimator = estimators.front();
  if (std::find(estimators.begin(), estimators.end(), border.estimator) == estimators.end()) {
    return invalid("border.estimator = " + border.estimator.substr(0, kMostShown) +
                   ": must be one of the sweep");
  }
  const Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  const Result<Grid> grid = grid_of(sweep, *cells, **along);
  return grid ? Status() : Status(grid.error());
}

Result<Envelope> find_envelope(const Sweep& sweep, const EnvelopeOptions& options) {
  const Result<const SweepAxis*> found = axis_along(sweep, options.border.axis);
  if (!found) return found.error();
  const SweepAxis* const along = *found;
  const Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  const Result<SweepPlan> plan = SweepPlan::make(sweep, *cells, options.flights.cancel);
  if (!plan) return plan.error();
  BorderSearch border = options.border;
  if (Status status = check_border(sweep, plan->estimators(), border); !status) {
    return status.error();
  }
  const Result<Grid> grid = grid_of(sweep, *cells, *along);
  if (!grid) return grid.error();
  const Result<RunLock> lock = lock_sweep(options.flights.folder);
  if (!lock) return lock.error();
  SweepOptions flights = options.flights;
  flights.lock = &*lock;
  flights.writes_progress = false;
  if (Status status = withdraw_outdated(sweep, flights); !status) return status.error();

  Envelope envelope{along->name, along->label, along->unit, border.estimator, {}, 0, 0};
  std::size_t flown_cells = 0;
  const AskPlaces ask = [&](const std::vector<GridPlace>& places) -> Result<std::vector<bool>> {
    std::vector<SweepCell> wanted;
    for (const auto& [line, value] : places) wanted.push_back(*grid->cells[line][value]);
    const Result<FlownSweep> flown = fly_cells(sweep, std::move(wanted), flights);
    if (!flown) return flown.error();
    write_whole_progress(sweep, flights, flown->progress);
    if (flown->cancelled) return Error{ErrorCode::kCancelled, "cancelled"};
    std::vector<bool> answers;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Result<bool> answer = survived(*flown, i, envelope.estimator);
      if (!answer) return answer.error();
      answers.push_back(*answer);
    }
    flown_cells += places.size();
    if (options.progress) options.progress(flown_cells);
    return answers;
  };
  const Result<Borders> borders = find_borders(grid->lines, along->values.size(), ask);
  if (!borders) return borders.error();

  envelope.cells = cells->size();
  envelope.cells_needed = borders->asked;
  const auto value_at = [&](const std::optional<std::size_t>& place) {
    return place ? std::optional<Json>(along->values[*place].value) : std::nullopt;
  };
  for (std::size_t i = 0; i < borders->lines.size(); ++i) {
    const LineBorder& line = borders->lines[i];
    envelope.lines.push_back(
        {grid->at[i], value_at(line.survives), value_at(line.fails), line.irregular});
  }
  return envelope;
}

std::string markdown_from(const Sweep& sweep, const Envelope& envelope) {
  std::string head = "|";
  std::string rule = "|";
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.name == envelope.axis) continue;
    head += " " + axis.label + " |";
    rule += "---|";
  }
  std::string text =
      head + " " + envelope.label + ": survives | fails | |\n" + rule + "---|---|---|\n";
  for (const EnvelopeLine& line : envelope.lines) {
    text += "|";
    for (const SweepAxis& axis : sweep.axes) {
      if (axis.name == envelope.axis) continue;
      text += " " + shown(line.at.at(axis.name), axis.unit) + " |";
    }
    text += " " + (line.survives ? shown(*line.survives, envelope.unit) : "nowhere") + " |";
    text += " " + (line.fails ? shown(*line.fails, envelope.unit) : "nowhere") + " |";
    text += line.irregular ? " survival does not end once |\n" : " |\n";
  }
  return text + "\nEstimator " + envelope.estimator + "; " + std::to_string(envelope.cells_needed) +
         " of " + std::to_string(envelope.cells) + " cells were needed.\n";
}

Json json_from(const Envelope& envelope) {
  Json lines = Json::array();
  for (const EnvelopeLine& line : envelope.lines) {
    lines.push_back({{"at", line.at},
                     {"survives", line.survives.value_or(nullptr)},
                     {"fails", line.fails.value_or(nullptr)},
                     {"irregular", line.irregular}});
  }
  return {{"axis", envelope.axis},
          {"label", envelope.label},
          {"unit", envelope.unit},
          {"estimator", envelope.estimator},
          {"cells", envelope.cells},
          {"cells_needed", envelope.cells_needed},
          {"lines", std::move(lines)}};
}

Status write_envelope(const fs::path& folder, const Envelope& envelope) {
  return write_json(envelope_file(folder), json_from(envelope));
}

Status write_border_search(const fs::path& folder, const Sweep& sweep, const BorderSearch& border) {
  const Result<const SweepAxis*> along = axis_along(sweep, border.axis);
  if (!along) return along.error();
  Json document =
      json_from({(*along)->name, (*along)->label, (*along)->unit, border.estimator, {}, 0, 0});
  document["lines"] = nullptr;
  return write_json(envelope_file(folder), document);
}

void remove_envelope(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(envelope_file(folder), ignored);
}

Result<Json> read_envelope(const fs::path& folder) {
  Result<Json> document = read_json(envelope_file(folder), kMaxEnvelopeBytes);
  if (!document) return document.error();
  const bool valid = document->is_object() && is_envelope(*document);
  if (valid) return document;
  return Error{ErrorCode::kUnreadable, envelope_file(folder).string() + ": is no envelope"};
}

}  // namespace overfly::server::experiments
