#include "server/experiments/envelope/envelope.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "server/experiments/envelope/border_search.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

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

}  // namespace

Result<Envelope> find_envelope(const Sweep& sweep, const EnvelopeOptions& options) {
  const auto along = std::find_if(sweep.axes.begin(), sweep.axes.end(), [&](const auto& axis) {
    return axis.name == options.axis;
  });
  if (along == sweep.axes.end()) {
    std::string names;
    for (const SweepAxis& axis : sweep.axes) names += (names.empty() ? "" : ", ") + axis.name;
    return invalid("axis = " + options.axis + ": must be an axis of the sweep (" + names + ")");
  }
  if (sweep.latin_hypercube || along->values.size() < 2) {
    return invalid("axis = " + options.axis +
                   ": must have at least two values, in a grid without a Latin hypercube");
  }
  const Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  const Result<Grid> grid = grid_of(sweep, *cells, *along);
  if (!grid) return grid.error();

  Envelope envelope{along->name, along->label, along->unit, options.estimator, {}, 0, 0};
  std::size_t flown_cells = 0;
  const AskPlaces ask = [&](const std::vector<GridPlace>& places) -> Result<std::vector<bool>> {
    std::vector<SweepCell> wanted;
    for (const auto& [line, value] : places) wanted.push_back(*grid->cells[line][value]);
    const Result<FlownSweep> flown = fly_cells(sweep, std::move(wanted), options.flights);
    if (!flown) return flown.error();
    if (flown->cancelled) return Error{ErrorCode::kCancelled, "cancelled"};
    const std::vector<std::string>& names = flown->plan.estimators();
    if (envelope.estimator.empty() && !names.empty()) envelope.estimator = names.front();
    if (std::find(names.begin(), names.end(), envelope.estimator) == names.end()) {
      return invalid("estimator = " + envelope.estimator + ": must be one of the sweep");
    }
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
    const LineBorder& border = borders->lines[i];
    envelope.lines.push_back(
        {grid->at[i], value_at(border.survives), value_at(border.fails), border.irregular});
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

}  // namespace overfly::server::experiments
