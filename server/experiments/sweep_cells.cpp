// The cells of a sweep: the grid of its axes, or points drawn from them.
#include <algorithm>
#include <random>
#include <utility>

#include "server/experiments/drawn_numbers.hpp"
#include "server/experiments/sweep_document.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

Error too_many_cells() {
  return {ErrorCode::kInvalidArgument,
          "axes: give more than " + std::to_string(kMaxCells) + " cells"};
}

/// What a cell gets from a value of an axis, as text.
std::size_t bytes_of(const SweepAxis& axis, const AxisValue& value) {
  std::size_t bytes = axis.name.size() + value.value.dump().size();
  for (const Override& change : value.changes) {
    bytes += change.path.size() + change.value.dump().size();
  }
  return bytes;
}

/// Before that many cells are made, each with copies of its values.
/// @pre each value of an axis is in as many cells as its others
Status check_size(const Sweep& sweep, std::size_t cells) {
  std::size_t bytes = 0;
  for (const SweepAxis& axis : sweep.axes) {
    std::size_t sum = 0;
    for (const AxisValue& value : axis.values) sum += bytes_of(axis, value);
    bytes += sum * cells / std::max<std::size_t>(axis.values.size(), 1);
  }
  if (bytes <= kMaxCellsBytes) return {};
  return Error{ErrorCode::kInvalidArgument,
               "axes: the values of " + std::to_string(cells) + " cells have " +
                   std::to_string(bytes >> 20U) + " MiB: must be at most " +
                   std::to_string(kMaxCellsBytes >> 20U) + " MiB"};
}

void add_value(SweepCell& cell, const SweepAxis& axis, const AxisValue& value) {
  cell.values[axis.name] = value.value;
  cell.changes.insert(cell.changes.end(), value.changes.begin(), value.changes.end());
}

Result<std::size_t> grid_size(const Sweep& sweep) {
  std::size_t size = 1;
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    const SweepAxis& axis = sweep.axes[i];
    if (axis.values.empty()) {
      return Error{
          ErrorCode::kInvalidArgument,
          "axes." + std::to_string(i) + ".step: must be given, except with latin_hypercube"};
    }
    size *= axis.values.size();
    if (size > kMaxCells) return too_many_cells();
  }
  return size;
}

std::vector<SweepCell> grid_cells(const Sweep& sweep) {
  std::vector<SweepCell> cells{{Json::object(), {}}};
  for (const SweepAxis& axis : sweep.axes) {
    std::vector<SweepCell> longer;
    for (const SweepCell& cell : cells) {
      for (const AxisValue& value : axis.values) {
        longer.push_back(cell);
        add_value(longer.back(), axis, value);
      }
    }
    cells = std::move(longer);
  }
  return cells;
}

/// Each axis is divided into as many equal parts as there are cells, and each part is used once
/// (McKay, Beckman, Conover 1979, Technometrics 21, 239-245).
std::vector<SweepCell> drawn_cells(const Sweep& sweep, const LatinHypercube& drawn) {
  std::mt19937_64 random(drawn.seed);
  std::vector<SweepCell> cells(drawn.cells, SweepCell{Json::object(), {}});
  const auto count = static_cast<double>(drawn.cells);
  for (const SweepAxis& axis : sweep.axes) {
    const std::vector<std::size_t> parts = shuffled(drawn.cells, random);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double share = (static_cast<double>(parts[i]) + unit_number(random)) / count;
      if (axis.range) {
        const auto [from, to] = *axis.range;
        const Json value = from + share * (to - from);
        add_value(cells[i], axis, {value, {{axis.name, value}}});
      } else {
        const auto size = static_cast<double>(axis.values.size());
        add_value(cells[i], axis, axis.values[static_cast<std::size_t>(share * size)]);
      }
    }
  }
  return cells;
}

bool value_matches(const Json& condition, const Json& value) {
  if (!condition.is_object()) return condition == value;
  if (!value.is_number()) return false;
  const auto number = value.get<double>();
  return number >= condition.value("min", -std::numeric_limits<double>::infinity()) &&
         number <= condition.value("max", std::numeric_limits<double>::infinity());
}

Status check_limits(const Json& condition, const std::string& field) {
  for (const auto& [key, value] : condition.items()) {
    if (key != "min" && key != "max") {
      return Error{ErrorCode::kInvalidArgument, field + "." + key + ": must be min or max"};
    }
    if (!value.is_number()) {
      return Error{ErrorCode::kInvalidArgument,
                   field + "." + key + " = " + value.dump() + ": must be a number"};
    }
  }
  return {};
}

Status check_skip(const Sweep& sweep) {
  for (std::size_t i = 0; i < sweep.skip.size(); ++i) {
    for (const auto& [name, condition] : sweep.skip[i].items()) {
      const std::string field = "skip." + std::to_string(i) + "." + name;
      const bool known = std::any_of(sweep.axes.begin(), sweep.axes.end(), [&](const auto& axis) {
        return axis.name == name;
      });
      if (!known) return Error{ErrorCode::kInvalidArgument, field + ": must be one of the axes"};
      if (!condition.is_object()) continue;
      if (Status status = check_limits(condition, field); !status) return status;
    }
  }
  return {};
}

}  // namespace

bool is_skipped(const std::vector<Json>& skip, const Json& values) {
  return std::any_of(skip.begin(), skip.end(), [&](const Json& entry) {
    const auto items = entry.items();
    return std::all_of(items.begin(), items.end(), [&](const auto& item) {
      const auto value = values.find(item.key());
      return value != values.end() && value_matches(item.value(), *value);
    });
  });
}

Result<std::vector<SweepCell>> cells_of(const Sweep& sweep) {
  if (sweep.chosen_cells) return *sweep.chosen_cells;
  if (Status status = check_skip(sweep); !status) return status.error();
  const std::optional<LatinHypercube>& drawn = sweep.latin_hypercube;
  const Result<std::size_t> size = drawn ? Result<std::size_t>(drawn->cells) : grid_size(sweep);
  if (!size) return size.error();
  if (Status status = check_size(sweep, *size); !status) return status.error();
  std::vector<SweepCell> cells = drawn ? drawn_cells(sweep, *drawn) : grid_cells(sweep);
  std::erase_if(cells, [&](const SweepCell& cell) { return is_skipped(sweep.skip, cell.values); });
  if (cells.empty()) {
    return Error{ErrorCode::kInvalidArgument, "skip: must leave at least one cell"};
  }
  return cells;
}

}  // namespace overfly::server::experiments
