#include "odometry/feature/map/id_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>
#include <vector>

namespace overfly::odometry::feature {
namespace {

struct Numbered {
  int id = 0;
  int value = 0;
};

std::vector<std::pair<int, int>> listed(const IdTable<Numbered>& table) {
  std::vector<std::pair<int, int>> all;
  for (const Numbered& object : table) all.emplace_back(object.id, object.value);
  return all;
}

TEST(IdTable, HoldsTheSameAsAMapOfTheStandardLibrary) {
  std::mt19937 generator(3);
  IdTable<Numbered> table;
  std::map<int, int> expected;
  int next = 40;
  for (int i = 0; i < 20000; ++i) {
    const auto chance = generator() % 100;
    if (chance < 50) {
      next += static_cast<int>(generator() % 3);
      table.add({next, i});
      expected[next] = i;
      ++next;
    } else if (chance < 98 && next > 40) {
      const int id = 40 + static_cast<int>(generator() % static_cast<unsigned>(next - 40));
      table.erase(id);
      expected.erase(id);
    } else {
      table.trim();
    }
    ASSERT_EQ(table.size(), expected.size());
    const int asked = 38 + static_cast<int>(generator() % static_cast<unsigned>(next - 36));
    const Numbered* found = table.find(asked);
    ASSERT_EQ(found != nullptr, expected.contains(asked)) << asked;
    if (found != nullptr) ASSERT_EQ(found->value, expected.at(asked));
    if (i % 500 == 0) {
      const std::vector<std::pair<int, int>> all(expected.begin(), expected.end());
      ASSERT_EQ(listed(table), all);
    }
  }
}

TEST(IdTable, KeepsReferencesUntilTheirObjectIsErased) {
  IdTable<Numbered> table;
  Numbered& kept = table.add({7, 1});
  for (int id = 8; id < 5000; ++id) table.add({id, id});
  for (int id = 9; id < 5000; ++id) table.erase(id);
  table.trim();
  IdTable<Numbered> moved = std::move(table);
  EXPECT_EQ(moved.find(7), &kept);
  EXPECT_EQ(kept.value, 1);
}

TEST(IdTable, AnEmptiedTableStartsAgainAtAnyId) {
  IdTable<Numbered> table;
  table.add({7, 1});
  table.erase(7);
  EXPECT_EQ(table.begin(), table.end());
  table.add({3, 2});
  EXPECT_EQ(listed(table), (std::vector<std::pair<int, int>>{{3, 2}}));
  EXPECT_EQ(table.find(-1), nullptr);
  EXPECT_THROW((void)table.at(7), std::out_of_range);
}

}  // namespace
}  // namespace overfly::odometry::feature
