// The end of an estimator: no process and no file of it remains.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "tests/support/support.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"
#include "vo_bridges/process/child/private_folder.hpp"

namespace overfly {
namespace {

using testing::alive;
using testing::gone_soon;
using testing::ground_frames;
using testing::scripted;
using testing::started;

class ProcessEnd : public testing::ChildrenTest {};

TEST_F(ProcessEnd, AChildThatDoesNotStopIsKilled) {
  int pid = 0;
  const double took_s = seconds_of([&] {
    const auto estimator = started(scripted("stubborn"));
    const auto frames = ground_frames(1, 1.0, 1.0, 64, 48);
    pid = static_cast<int>(estimator->track(frames[0])->counters.at("pid"));
  });
  EXPECT_FALSE(alive(pid));
  EXPECT_GT(took_s, 2.5) << "it was given time";
  EXPECT_LT(took_s, 10.0);
}

TEST_F(ProcessEnd, GrandchildrenDieWithTheChild) {
  int grandchild = 0;
  {
    const auto estimator = started(scripted("grandchild"));
    for (const VoFrame& frame : ground_frames(4, 1.0, 1.0, 64, 48)) {
      grandchild = static_cast<int>(estimator->track(frame)->counters.at("child"));
    }
    ASSERT_GT(grandchild, 0);
    EXPECT_TRUE(alive(grandchild));
  }
  EXPECT_TRUE(gone_soon(grandchild));
}

TEST_F(ProcessEnd, GrandchildrenThatCutThemselvesLooseDieWithTheChild) {
  const auto daemon_of = [](VoPort& estimator) {
    int daemon = 0;
    for (const VoFrame& frame : ground_frames(4, 1.0, 1.0, 64, 48)) {
      daemon = static_cast<int>(estimator.track(frame)->counters.at("child"));
    }
    EXPECT_GT(daemon, 0);
    EXPECT_TRUE(alive(daemon));
    return daemon;
  };
  auto one = started(scripted("loose_grandchild"));
  auto other = started(scripted("loose_grandchild"));
  const int of_one = daemon_of(*one);
  const int of_other = daemon_of(*other);
  one.reset();
  EXPECT_FALSE(alive(of_one));
  EXPECT_TRUE(alive(of_other)) << "another estimator's";
  other.reset();
  EXPECT_FALSE(alive(of_other));
}

TEST_F(ProcessEnd, TemporaryFilesGoIntoAFolderOfItsOwnAndAreRemoved) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "estimator.py";
  testing::write_text(file,
                      "import os, sys, tempfile\n"
                      "sys.path.insert(0, sys.argv[1])\n"
                      "import overfly_vo\n"
                      "class Writer(overfly_vo.Estimator):\n"
                      "    def track(self, frame):\n"
                      "        os.makedirs(os.path.join(tempfile.gettempdir(), 'a', 'b'))\n"
                      "        self.log(1, tempfile.gettempdir())\n"
                      "        return overfly_vo.Answer()\n"
                      "overfly_vo.run(Writer())\n");
  ProcessEstimatorOptions options = scripted("good");
  options.command = {
      "python3", "-B", file.string(), testing::source_file("vo_bridges/client").string()};
  const VoFrame frame = ground_frames(1, 1.0, 1.0, 64, 48)[0];
  std::set<std::filesystem::path> folders;
  {
    const auto one = started(options);
    const auto other = started(options);
    for (VoPort* estimator : {one.get(), other.get()}) {
      ASSERT_TRUE(estimator->track(frame).ok()) << "the name is not taken";
      for (const std::string& line : lines_with(*estimator, "overfly-estimator-"))
        folders.insert(line);
    }
    ASSERT_EQ(folders.size(), 2U);
    for (const std::filesystem::path& its : folders) {
      EXPECT_TRUE(std::filesystem::is_directory(its / "a" / "b")) << its;
    }
  }
  for (const std::filesystem::path& its : folders) EXPECT_FALSE(std::filesystem::exists(its));
}

/// Folders of killed programs go; those in use, or made just now, stay.
TEST_F(ProcessEnd, FoldersThatNobodyUsesAnyMoreAreRemoved) {
  namespace fs = std::filesystem;
  const auto made = [] {
    std::string folder = (fs::temp_directory_path() / "overfly-estimator-XXXXXX").string();
    EXPECT_NE(::mkdtemp(folder.data()), nullptr);
    fs::create_directories(fs::path(folder) / "a");
    return fs::path(folder);
  };
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
  const fs::path left = made();
  const fs::path young = made();
  auto used = process::PrivateFolder::create();
  ASSERT_TRUE(used.ok()) << used.error().message;
  for (const fs::path& folder : {left, used->path()}) fs::last_write_time(folder, long_ago);
  const auto next = process::PrivateFolder::create();
  ASSERT_TRUE(next.ok()) << next.error().message;
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(used->path()));
  EXPECT_TRUE(fs::exists(young));
  fs::remove_all(young);
}

TEST_F(ProcessEnd, AKilledServerLeavesNoOrphan) {
  std::array<int, 2> told{};
  ASSERT_EQ(::pipe(told.data()), 0);
  const pid_t server = ::fork();
  if (server == 0) {
    const auto estimator = started(scripted("stubborn"));
    const auto frames = ground_frames(1, 1.0, 1.0, 64, 48);
    const int pid = static_cast<int>(estimator->track(frames[0])->counters.at("pid"));
    [[maybe_unused]] const ssize_t written = ::write(told[1], &pid, sizeof(pid));
    for (;;) ::pause();
  }
  int pid = 0;
  ::close(told[1]);
  ASSERT_EQ(::read(told[0], &pid, sizeof(pid)), static_cast<ssize_t>(sizeof(pid)));
  ::close(told[0]);
  EXPECT_TRUE(alive(pid));
  ::kill(server, SIGKILL);
  ::waitpid(server, nullptr, 0);
  EXPECT_TRUE(gone_soon(pid));
  ::waitpid(pid, nullptr, 0);  // ours now: earlier children made this process their subreaper
}

}  // namespace
}  // namespace overfly
