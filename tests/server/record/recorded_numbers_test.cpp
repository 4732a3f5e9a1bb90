#include "server/record/recorded_numbers.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

class RecordedNumbersTest : public ::testing::Test {
 protected:
  void add(const std::string& name) { overfly::testing::write_text(folder_.path() / name, ""); }
  /// Lets the folder look as if nothing had changed in it for a while.
  void settle() {
    fs::last_write_time(folder_.path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
  }
  [[nodiscard]] std::optional<std::int64_t> last(std::int64_t frame) {
    return numbers_.last(folder_.path(), frame);
  }

  overfly::testing::TemporaryFolder folder_;
  RecordedNumbers numbers_;
};

TEST_F(RecordedNumbersTest, GivesTheLastAtOrBeforeAFrame) {
  for (const char* name : {"000006.jpg", "000012.jpg", "000100.jpg", "notes.txt", "12a.jpg"}) {
    add(name);
  }
  EXPECT_FALSE(last(5));
  EXPECT_EQ(last(6), 6);
  EXPECT_EQ(last(99), 12);
  EXPECT_EQ(last(1000), 100);
}

TEST_F(RecordedNumbersTest, NoticesFilesThatAreAddedWhileItIsWatched) {
  add("000001.jpg");
  EXPECT_EQ(last(50), 1);
  add("000040.jpg");
  EXPECT_EQ(last(50), 40);
}

TEST_F(RecordedNumbersTest, ListsAFolderAtRestOnce) {
  add("000001.jpg");
  settle();
  EXPECT_EQ(last(50), 1);
  const auto listed = fs::last_write_time(folder_.path());
  add("000040.jpg");
  fs::last_write_time(folder_.path(), listed);
  EXPECT_EQ(last(50), 1) << "the folder's time says that nothing has changed";
  settle();
  EXPECT_EQ(last(50), 40);
}

TEST_F(RecordedNumbersTest, HasNoneInAFolderThatIsMissing) {
  EXPECT_FALSE(numbers_.last(folder_.path() / "absent", 9));
}

}  // namespace
}  // namespace overfly::server
