// The border found by bisection is that of the full grid, with few of its places asked.
#include "server/experiments/envelope/border_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

namespace overfly::server::experiments {
namespace {

using Survives = std::function<bool(const GridLine&, std::size_t)>;

std::vector<GridLine> lines_of(std::size_t rows, std::size_t layers = 1) {
  std::vector<GridLine> lines;
  for (std::size_t layer = 0; layer < layers; ++layer) {
    for (std::size_t row = 0; row < rows; ++row) lines.push_back({{layer, row}});
  }
  return lines;
}

/// Searches, and checks that no place is asked twice.
Borders search(const std::vector<GridLine>& lines, std::size_t values, const Survives& survives) {
  std::set<GridPlace> asked;
  const auto found = find_borders(lines, values, [&](const std::vector<GridPlace>& places) {
    EXPECT_LE(places.size(), 2U);
    std::vector<bool> answers;
    for (const GridPlace& place : places) {
      EXPECT_LT(place.value, values);
      EXPECT_TRUE(asked.insert(place).second) << place.line << ", " << place.value;
      answers.push_back(survives(lines[place.line], place.value));
    }
    return Result<std::vector<bool>>(answers);
  });
  EXPECT_TRUE(found.ok());
  EXPECT_EQ(found->asked, asked.size());
  return *found;
}

/// The border of the full grid: survival begins or ends once on a line.
void expect_true_borders(const Borders& found,
                         const std::vector<GridLine>& lines,
                         std::size_t values,
                         const Survives& survives) {
  const bool reversed = std::any_of(lines.begin(), lines.end(), [&](const GridLine& line) {
    return !survives(line, 0) && survives(line, values - 1);
  });
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::size_t> good;
    std::vector<std::size_t> bad;
    for (std::size_t v = 0; v < values; ++v) (survives(lines[i], v) ? good : bad).push_back(v);
    const LineBorder& border = found.lines[i];
    EXPECT_FALSE(border.irregular) << i;
    ASSERT_EQ(border.survives.has_value(), !good.empty()) << i;
    ASSERT_EQ(border.fails.has_value(), !bad.empty()) << i;
    if (good.empty() || bad.empty()) {
      // The hard end if all survive, the easy one if none does.
      EXPECT_EQ(bad.empty() ? border.survives : border.fails,
                bad.empty() == reversed ? 0 : values - 1)
          << i;
      continue;
    }
    EXPECT_TRUE(survives(lines[i], *border.survives)) << i;
    EXPECT_FALSE(survives(lines[i], *border.fails)) << i;
    const std::size_t apart =
        std::max(*border.survives, *border.fails) - std::min(*border.survives, *border.fails);
    EXPECT_EQ(apart, 1U) << i;
  }
}

TEST(BorderSearch, FindsASlopingBorderWithAThirdOfTheFlights) {
  const auto lines = lines_of(12, 4);
  for (const bool reversed : {false, true}) {
    const Survives survives = [reversed](const GridLine& line, std::size_t v) {
      const double border =
          2.5 + 0.6 * static_cast<double>(line.at[1]) + 1.3 * static_cast<double>(line.at[0]);
      const std::size_t place = reversed ? 15 - v : v;
      return static_cast<double>(place) < border;
    };
    const Borders found = search(lines, 16, survives);
    expect_true_borders(found, lines, 16, survives);
    EXPECT_LT(3 * found.asked, 16 * lines.size()) << found.asked;
  }
}

TEST(BorderSearch, FindsEveryBorderOfALine) {
  for (std::size_t values = 1; values <= 9; ++values) {
    for (std::size_t first = 0; first <= values; ++first) {
      for (std::size_t second = 0; second <= values; ++second) {
        for (const bool reversed : {false, true}) {
          const auto lines = lines_of(2);
          const Survives survives = [&](const GridLine& line, std::size_t v) {
            const std::size_t place = reversed ? values - 1 - v : v;
            return place < (line.at[1] == 0 ? first : second);
          };
          expect_true_borders(search(lines, values, survives), lines, values, survives);
        }
      }
    }
  }
}

TEST(BorderSearch, NeedsOneFlightOfALineWhereNoneFailsNextToOthers) {
  const auto lines = lines_of(10);
  const Survives survives = [](const GridLine& line, std::size_t v) {
    return line.at[1] > 0 || v < 3;
  };
  const Borders found = search(lines, 8, survives);
  expect_true_borders(found, lines, 8, survives);
  EXPECT_LT(found.asked, 8U + 4U + 8U);
}

/// Recorded: 320x240, 6 s at 25 m/s, read noise of 10 to 2400 electrons along the line, defocus of
/// 0 to 6 px across.
TEST(BorderSearch, AgreesWithARecordedGrid) {
  const std::vector<std::string> grid = {"+++--", "+++--", "+++--", "+----"};
  const auto lines = lines_of(grid.size());
  const Survives survives = [&](const GridLine& line, std::size_t v) {
    return grid[line.at[1]][v] == '+';
  };
  const Borders found = search(lines, 5, survives);
  expect_true_borders(found, lines, 5, survives);
  EXPECT_EQ(found.asked, 12U);
}

/// Recorded: scenarios/sweeps/blur_envelope.json, heights of 20 to 170 m along the line, exposures
/// of 5 to 30 ms across, at 15 m/s and (up to 20 ms) at 25 m/s.
TEST(BorderSearch, FindsTheBorderOfARecordedGridWithAThirdOfItsFlights) {
  const std::vector<std::vector<std::size_t>> lost_below = {{0, 0, 1, 1, 1, 1}, {2, 2, 3, 3}};
  std::vector<GridLine> lines;
  for (std::size_t speed = 0; speed < lost_below.size(); ++speed) {
    for (std::size_t exposure = 0; exposure < lost_below[speed].size(); ++exposure) {
      lines.push_back({{speed, exposure}});
    }
  }
  constexpr std::size_t kHeights = 16;
  const Survives survives = [&](const GridLine& line, std::size_t v) {
    return v >= lost_below[line.at[0]][line.at[1]];
  };
  const Borders found = search(lines, kHeights, survives);
  expect_true_borders(found, lines, kHeights, survives);
  EXPECT_LT(3 * found.asked, kHeights * lines.size()) << found.asked;
}

TEST(BorderSearch, MarksALineWithSeveralBorders) {
  const auto lines = lines_of(2);
  const std::vector<std::string> grid = {"++++----", "+++-++--"};
  const Borders found = search(
      lines, 8, [&](const GridLine& line, std::size_t v) { return grid[line.at[1]][v] == '+'; });
  EXPECT_FALSE(found.lines[0].irregular);
  EXPECT_TRUE(found.lines[1].irregular);
  ASSERT_TRUE(found.lines[1].survives && found.lines[1].fails);
  EXPECT_EQ(grid[1][*found.lines[1].survives], '+');
  EXPECT_EQ(grid[1][*found.lines[1].fails], '-');
}

TEST(BorderSearch, ReturnsTheErrorOfAFlight) {
  const auto found = find_borders(lines_of(3), 4, [](const std::vector<GridPlace>&) {
    return Result<std::vector<bool>>(Error{ErrorCode::kCancelled, "cancelled"});
  });
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::server::experiments
