#include "terrain/elevation/void_plateaus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace overfly::terrain {
namespace {

/// Maximum number of runs and plateaus in memory (about 200 MB).
constexpr std::size_t kMostKept = 6'000'000;

/// Whether such a step between neighbouring posts occurs on real ground.
bool is_possible(double step_m, double spacing_m, float value) {
  constexpr double kLeastM = 50.0;  // a quay, a wall or a bank may have any slope
  constexpr double kTangent70Deg = 2.75;
  constexpr double kPitM = 2000.0;  // a hole of the numbers below -9000
  if (value < 0.0F && step_m >= kPitM) return false;
  return step_m < kLeastM || step_m <= kTangent70Deg * spacing_m;
}

bool overlap(const VoidRuns::Run& a, const VoidRuns::Run& b) {
  return a.first <= b.last && b.first <= a.last;
}

}  // namespace

bool is_usual_void(float value) {
  if (value == 0.0F) return true;
  constexpr std::array<float, 8> kValues{
      9999.0F, 32767.0F, 65535.0F, -9999.0F, -10000.0F, -32767.0F, -32768.0F, -99999.0F};
  return std::abs(value) >= kValues[0] &&
         std::find(kValues.begin(), kValues.end(), value) != kValues.end();
}

void VoidRuns::erase_from(HeightGrid& window, int column, int row) const {
  auto run = std::lower_bound(
      runs.begin(), runs.end(), row, [](const Run& a, int wanted) { return a.row < wanted; });
  for (; run != runs.end() && run->row < row + window.rows; ++run) {
    const int first = std::max(run->first - column, 0);
    const int last = std::min(run->last - column, window.columns - 1);
    for (int i = first; i <= last; ++i) {
      window.at(i, run->row - row) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

VoidPlateaus::Label VoidPlateaus::root(Label label) {
  while (plateaus_[static_cast<std::size_t>(label)].parent != label) {
    Plateau& plateau = plateaus_[static_cast<std::size_t>(label)];
    plateau.parent = plateaus_[static_cast<std::size_t>(plateau.parent)].parent;
    label = plateau.parent;
  }
  return label;
}

VoidPlateaus::Label VoidPlateaus::joined(Label a, Label b) {
  a = root(a);
  b = root(b);
  if (a == b) return a;
  Plateau& into = plateaus_[static_cast<std::size_t>(a)];
  Plateau& from = plateaus_[static_cast<std::size_t>(b)];
  from.parent = a;
  into.possible += from.possible;
  into.impossible += from.impossible;
  return a;
}

bool VoidPlateaus::is_void(const Plateau& plateau) const {
  // Numbers below -9000 are hardly ever heights, so a majority of the surrounding posts is enough,
  // and a few false ones (edges that were interpolated) do not matter. All other values require
  // every surrounding post.
  if (plateau.value < 0.0F) return plateau.impossible >= plateau.possible;
  return plateau.impossible > 0 && plateau.possible == 0;
}

void VoidPlateaus::judge(Label label, float value_m, const Row& row, int column) {
  const auto i = static_cast<std::size_t>(column);
  if (std::isnan(row.height_m[i]) || is_usual_void(row.raw[i])) return;
  Plateau& plateau = plateaus_[static_cast<std::size_t>(root(label))];
  const double step_m = std::abs(static_cast<double>(row.height_m[i]) - value_m);
  ++(is_possible(step_m, spacing_m_, plateau.value) ? plateau.possible : plateau.impossible);
}

void VoidPlateaus::find_runs(Row& row) {
  for (int i = 0; i < columns_; ++i) {
    const float value = row.raw[static_cast<std::size_t>(i)];
    if (!is_usual_void(value) || std::isnan(row.height_m[static_cast<std::size_t>(i)])) continue;
    const int first = i;
    while (i + 1 < columns_ && row.raw[static_cast<std::size_t>(i) + 1] == value) ++i;
    const auto label = static_cast<Label>(plateaus_.size());
    plateaus_.push_back({label, value, 0, 0});
    row.runs.push_back({{next_row_, first, i}, label});
  }
}

void VoidPlateaus::join_above(Row& row) {
  std::size_t upper = 0;
  for (LabelledRun& run : row.runs) {
    while (upper < above_.runs.size() && above_.runs[upper].run.last < run.run.first) ++upper;
    for (std::size_t k = upper; k < above_.runs.size() && overlap(above_.runs[k].run, run.run);
         ++k) {
      const Label other = root(above_.runs[k].label);
      const Label own = root(run.label);
      if (plateaus_[static_cast<std::size_t>(other)].value ==
          plateaus_[static_cast<std::size_t>(own)].value) {
        run.label = joined(other, own);
      }
    }
  }
}

void VoidPlateaus::judge_sides(const Row& row) {
  for (const LabelledRun& run : row.runs) {
    const float value_m = row.height_m[static_cast<std::size_t>(run.run.first)];
    if (run.run.first > 0) judge(run.label, value_m, row, run.run.first - 1);
    if (run.run.last + 1 < columns_) judge(run.label, value_m, row, run.run.last + 1);
  }
}

void VoidPlateaus::judge_between(const Row& upper, const Row& lower) {
  for (const auto& [of, adjacent] : {std::pair(&upper, &lower), std::pair(&lower, &upper)}) {
    for (const LabelledRun& run : of->runs) {
      const float value_m = of->height_m[static_cast<std::size_t>(run.run.first)];
      for (int i = run.run.first; i <= run.run.last; ++i) judge(run.label, value_m, *adjacent, i);
    }
  }
}

void VoidPlateaus::store_above() {
  for (const LabelledRun& run : above_.runs) {
    const Plateau& plateau = plateaus_[static_cast<std::size_t>(root(run.label))];
    if (plateau.value < 0.0F || plateau.possible == 0) stored_.push_back(run);
  }
}

void VoidPlateaus::add_row(const float* raw, const float* height_m) {
  if (too_many_) return;
  Row row{{raw, raw + columns_}, {height_m, height_m + columns_}, {}};
  find_runs(row);
  if (!above_.raw.empty()) {
    join_above(row);
    judge_between(above_, row);
  }
  judge_sides(row);
  store_above();
  above_ = std::move(row);
  ++next_row_;
  if (plateaus_.size() + stored_.size() < compact_at_) return;
  compact();
  too_many_ = plateaus_.size() + stored_.size() > kMostKept;
  compact_at_ = 2 * std::max(compact_at_ / 2, plateaus_.size() + stored_.size());
}

void VoidPlateaus::compact() {
  std::vector<Plateau> kept;
  std::vector<Label> moved(plateaus_.size(), -1);
  const auto keep = [&](LabelledRun& run) {
    const Label old = root(run.label);
    Label& label = moved[static_cast<std::size_t>(old)];
    if (label < 0) {
      label = static_cast<Label>(kept.size());
      kept.push_back(plateaus_[static_cast<std::size_t>(old)]);
      kept.back().parent = label;
    }
    run.label = label;
  };
  std::erase_if(stored_, [this](const LabelledRun& run) {
    const Plateau& plateau = plateaus_[static_cast<std::size_t>(root(run.label))];
    return plateau.value >= 0.0F && plateau.possible > 0;
  });
  std::for_each(stored_.begin(), stored_.end(), keep);
  std::for_each(above_.runs.begin(), above_.runs.end(), keep);
  plateaus_ = std::move(kept);
}

VoidRuns VoidPlateaus::finish() {
  VoidRuns found;
  if (too_many_) return found;
  store_above();
  for (const LabelledRun& run : stored_) {
    const Plateau& plateau = plateaus_[static_cast<std::size_t>(root(run.label))];
    if (!is_void(plateau)) continue;
    found.runs.push_back(run.run);
    found.posts += run.run.last - run.run.first + 1;
    found.values.insert(plateau.value);
  }
  return found;
}

}  // namespace overfly::terrain
