// Names that the system refuses (too long, circular links) are errors, not exceptions.
#include <gtest/gtest.h>

#include "core/motion/trajectory_io.hpp"
#include "server/export/export_source.hpp"
#include "server/export/video_export.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

class OddNames : public testing::ManagerTest {
 protected:
  /// A link to itself.
  static fs::path loop(const fs::path& file) {
    fs::create_symlink(file.filename(), file);
    return file;
  }
  [[nodiscard]] fs::path too_long() const { return root() / std::string(300, 'x'); }
};

TEST_F(OddNames, OfTheFolderOfScenarios) {
  for (const fs::path& folder : {too_long(), loop(root() / "loop")}) {
    RunManagerOptions odd = options();
    odd.scenarios_folder = folder;
    const auto runs = RunManager::create(odd);
    ASSERT_FALSE(runs.ok());
    EXPECT_EQ(runs.error().code, ErrorCode::kNotFound);
  }
}

TEST_F(OddNames, InTheFolderOfARun) {
  const fs::path folder = root() / "odd";
  fs::create_directories(folder);
  loop(manifest_file(folder));
  RunOptions options;
  options.folder = folder;
  options.renderer_factory = testing::noop_factory();
  const auto result = run_scenario(testing::small_scenario({}), options);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kConflict) << result.error().message;
}

TEST_F(OddNames, BesideTheScenariosAndTheRuns) {
  const auto runs = manager();
  fly(*runs);
  loop(root() / "scenarios" / "loop.json");
  loop(root() / "runs" / "loop");
  fs::create_directories(root() / "runs" / "odd");
  loop(manifest_file(root() / "runs" / "odd"));
  EXPECT_EQ(runs->library().list().size(), 2U);
  EXPECT_FALSE(runs->library().document("loop").ok());
  EXPECT_FALSE(runs->library().document(std::string(300, 'x')).ok());
  EXPECT_EQ(runs->runs().size(), 1U);
  for (const std::string& id : {std::string("loop"), std::string("odd"), std::string(300, 'x')}) {
    EXPECT_FALSE(runs->run(id).ok()) << id;
    EXPECT_FALSE(runs->timeline(id).ok()) << id;
    EXPECT_FALSE(runs->world_of(id).ok()) << id;
    EXPECT_FALSE(runs->remove(id).ok()) << id;
  }
}

TEST_F(OddNames, OfWhatIsExported) {
  for (const fs::path& path : {too_long(), loop(root() / "loop")}) {
    EXPECT_FALSE(open_export_source(path, {}).ok());
  }
  const ExportSource source{testing::small_scenario({}), std::nullopt, 0};
  VideoOptions video;
  video.file = root() / "loop";
  const auto made = export_video(source, video);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kConflict) << made.error().message;
}

TEST_F(OddNames, OfTheTimesBesidePoses) {
  overfly::testing::write_text(root() / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  loop(root() / "times.txt");
  const auto poses = read_trajectory(root() / "poses.txt");
  EXPECT_TRUE(poses.ok() || poses.error().code == ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace overfly::server
