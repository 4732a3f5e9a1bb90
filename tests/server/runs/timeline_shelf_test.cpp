// Timelines that are kept: those that somebody holds, and of a run that another process writes.
#include "server/runs/timeline_shelf.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "server/record/run_lock.hpp"
#include "server/run/run_options.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;

class TimelineShelfTest : public ::testing::Test {
 protected:
  void SetUp() override {
    RunOptions options;
    options.folder = run("r0");
    options.renderer_factory = testing::noop_factory();
    const auto flown = run_scenario(testing::small_scenario({"duration_s=0.4"}), options);
    ASSERT_TRUE(flown.ok()) << flown.error().message;
  }
  [[nodiscard]] fs::path run(const std::string& id) const { return folder_.path() / "runs" / id; }

  TemporaryFolder folder_;
  TimelineShelf shelf_{RunPlaces(folder_.path() / "runs", {})};
};

TEST_F(TimelineShelfTest, KeepsAllThatAreHeld) {
  constexpr std::size_t kHeld = 2 * TimelineShelf::kMostUnused;
  std::vector<std::shared_ptr<RunTimeline>> held;
  for (std::size_t i = 0; i < kHeld; ++i) {
    const std::string id = "r" + std::to_string(i);
    if (i > 0) fs::copy(run("r0"), run(id), fs::copy_options::recursive);
    const auto timeline = shelf_.get(id);
    ASSERT_TRUE(timeline.ok()) << timeline.error().message;
    held.push_back(*timeline);
  }
  for (std::size_t i = 0; i < kHeld; ++i) {
    EXPECT_EQ(shelf_.get("r" + std::to_string(i)).value(), held[i]) << i;
  }
  // Of those that nobody holds any more only some stay.
  std::vector<std::weak_ptr<RunTimeline>> freed(held.begin(), held.end());
  held.clear();
  fs::copy(run("r0"), run("new"), fs::copy_options::recursive);
  ASSERT_TRUE(shelf_.get("new").ok());
  std::size_t kept = 0;
  for (const auto& timeline : freed) kept += timeline.expired() ? 0 : 1;
  EXPECT_EQ(kept, TimelineShelf::kMostUnused);
}

/// It is drawn many times a second, and read once.
TEST_F(TimelineShelfTest, DoesNotReadARunThatIsWrittenForEveryPicture) {
  std::string manifest = read_text(run("r0") / "manifest.json");
  const std::size_t at = manifest.find("\"completed\"");
  ASSERT_NE(at, std::string::npos);
  write_text(run("r0") / "manifest.json", manifest.replace(at, 11, "\"running\""));
  const auto writing = RunLock::take(run("r0"));
  ASSERT_TRUE(writing.ok());
  const auto first = shelf_.get("r0");
  ASSERT_TRUE(first.ok()) << first.error().message;
  ASSERT_EQ((*first)->info().status, RunStatus::kRunning);
  EXPECT_EQ(shelf_.get("r0").value(), *first);
}

}  // namespace
}  // namespace overfly::server
