#include "server/experiments/tables/published_errors.hpp"

#include <utility>

#include "server/experiments/sweep_document.hpp"
#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

std::vector<std::optional<double>> values_from(const FileField& field, std::size_t count) {
  std::vector<std::optional<double>> values;
  for (const FileField& item : field.items()) {
    values.push_back(item.is_null() ? std::optional<double>() : item.number());
  }
  if (values.size() != count) {
    field.reject("have a value for each of the " + std::to_string(count) + " estimators");
  }
  return values;
}

PublishedErrors published_from(const FileField& document) {
  PublishedErrors published;
  published.source = document.at("source").text();
  for (const FileField& name : document.at("estimators").items()) {
    published.estimators.push_back(name.text());
  }
  for (const FileField& row : document.at("rows").items()) {
    const FileField cell = row.at("cell");
    if (!cell.value().is_object()) cell.reject("be an object");
    published.cells.push_back({cell.value(),
                               values_from(row.at("position_m"), published.estimators.size()),
                               values_from(row.at("rotation_deg"), published.estimators.size())});
  }
  return published;
}

using Medians = std::map<std::string, double>;  ///< by published name

struct ComparedCell {
  Medians position_m;
  Medians rotation_deg;
};

/// -1, 0 or 1: the first is better, equal, worse.
int order_of(double first, double second) { return first < second ? -1 : first > second ? 1 : 0; }

void add_cell(const Medians& own,
              const std::vector<std::optional<double>>& values,
              std::size_t i,
              std::size_t j,
              OrderingAgreement& agreement) {
  const auto first = own.find(agreement.first);
  const auto second = own.find(agreement.second);
  if (!values[i] || !values[j] || first == own.end() || second == own.end()) return;
  const int as_published = order_of(*values[i], *values[j]);
  ++agreement.cells;
  agreement.first_better += as_published < 0 ? 1 : 0;
  agreement.same += as_published == order_of(first->second, second->second) ? 1 : 0;
}

}  // namespace

const PublishedCell* PublishedErrors::find(const nlohmann::json& cell) const {
  for (const PublishedCell& row : cells) {
    bool same = true;
    for (const auto& [axis, value] : row.cell.items()) {
      same = same && cell.contains(axis) && cell.at(axis) == value;
    }
    if (same) return &row;
  }
  return nullptr;
}

std::optional<std::size_t> PublishedErrors::index_of(const std::string& estimator) const {
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    if (estimators[i] == estimator) return i;
  }
  return std::nullopt;
}

Result<PublishedErrors> read_published_errors(const std::filesystem::path& file) {
  const Result<nlohmann::json> document = read_json(file, kMaxSweepBytes);
  if (!document) return document.error();
  Result<PublishedErrors> published =
      guarded_fields([&] { return published_from(FileField(*document)); });
  if (!published) return published.error().in(file.string());
  return published;
}

std::vector<OrderingAgreement> ordering_agreements(
    const std::vector<CellScores>& rows,
    std::size_t convention,
    const PublishedErrors& published,
    const std::map<std::string, std::string>& counterparts) {
  // A published cell may have several cells here: those of a further axis.
  std::map<std::pair<nlohmann::json, const PublishedCell*>, ComparedCell> cells;
  for (const CellScores& row : rows) {
    const auto name = counterparts.find(row.estimator);
    const PublishedCell* const cell = published.find(row.cell);
    if (name == counterparts.end() || cell == nullptr) continue;
    const CellErrors& errors = row.errors[convention];
    const std::pair own(row.cell, cell);
    if (errors.position_m) {
      cells[own].position_m[name->second] = errors.position_m->quartiles.median;
    }
    if (errors.rotation_deg) {
      cells[own].rotation_deg[name->second] = errors.rotation_deg->quartiles.median;
    }
  }
  std::vector<OrderingAgreement> agreements;
  for (std::size_t i = 0; i < published.estimators.size(); ++i) {
    for (std::size_t j = i + 1; j < published.estimators.size(); ++j) {
      OrderingAgreement position{published.estimators[i], published.estimators[j], "position_m"};
      OrderingAgreement rotation{published.estimators[i], published.estimators[j], "rotation_deg"};
      for (const auto& [place, own] : cells) {
        add_cell(own.position_m, place.second->position_m, i, j, position);
        add_cell(own.rotation_deg, place.second->rotation_deg, i, j, rotation);
      }
      if (position.cells > 0) agreements.push_back(std::move(position));
      if (rotation.cells > 0) agreements.push_back(std::move(rotation));
    }
  }
  return agreements;
}

}  // namespace overfly::server::experiments
