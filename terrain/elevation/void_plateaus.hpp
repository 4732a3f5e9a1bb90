// Inside terrain only: detects undeclared no-data values in posts.
//
// Method: plateaus of one such value, connected along rows and columns, are found in one pass over
// the rows (runs joined by union-find; Rosenfeld and Pfaltz 1966, doi:10.1145/321356.321357). A
// plateau is void if the step to the posts around it does not occur on real ground: a sea at 0 m
// has a beach somewhere, a hole filled with 0 in ground at 300 m has none.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "terrain/elevation/height_grid.hpp"

namespace overfly::terrain {

/// 0, 9999, 32767, 65535, and -9999, -10000, -32767, -32768, -99999, in the raster's own numbers.
[[nodiscard]] bool is_usual_void(float value);

/// Posts found to be void, as runs along rows, in order.
struct VoidRuns {
  struct Run {
    int row = 0;
    int first = 0;  ///< column
    int last = 0;   ///< column, included
  };
  std::vector<Run> runs;
  double posts = 0.0;
  std::set<float> values;

  /// Sets the void posts of a window to NaN; the window's first post is (column, row).
  void erase_from(HeightGrid& window, int column, int row) const;
};

class VoidPlateaus {
 public:
  VoidPlateaus(int columns, double spacing_m) : columns_(columns), spacing_m_(spacing_m) {}

  /// Adds the next row of posts, from the top.
  /// @param raw  `columns` numbers in the raster's units
  /// @param height_m  the same as heights, NaN where there is no data
  void add_row(const float* raw, const float* height_m);
  /// The void plateaus, after the last row. Empty if there were too many to keep in memory.
  [[nodiscard]] VoidRuns finish();

 private:
  using Label = std::int32_t;
  struct Plateau {
    Label parent = 0;
    float value = 0.0F;
    std::int64_t possible = 0;    ///< neighbouring posts with a plausible step
    std::int64_t impossible = 0;  ///< neighbouring posts with an implausible step
  };
  struct LabelledRun {
    VoidRuns::Run run;
    Label label = 0;
  };
  struct Row {
    std::vector<float> raw;
    std::vector<float> height_m;
    std::vector<LabelledRun> runs;
  };

  [[nodiscard]] Label root(Label label);
  [[nodiscard]] Label joined(Label a, Label b);
  [[nodiscard]] bool is_void(const Plateau& plateau) const;
  /// Counts a post next to a plateau.
  void judge(Label label, float value_m, const Row& row, int column);
  void find_runs(Row& row);
  void join_above(Row& row);
  void judge_sides(const Row& row);
  void judge_between(const Row& upper, const Row& lower);
  void store_above();
  /// Discards the plateaus that are known to be ground, and those without posts.
  void compact();

  int columns_;
  double spacing_m_;
  int next_row_ = 0;
  bool too_many_ = false;
  std::size_t compact_at_ = std::size_t{1} << 20U;  ///< plateaus and runs kept
  Row above_;
  std::vector<Plateau> plateaus_;
  std::vector<LabelledRun> stored_;  ///< of finished rows, without those known to be ground
};

}  // namespace overfly::terrain
