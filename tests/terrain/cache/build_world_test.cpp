// A built world is the files' world: same bytes, sooner; and never another picture.
#include "terrain/build_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "tests/terrain/cache/built_world.hpp"

namespace overfly::terrain {
namespace {

TEST_F(BuildWorld, GivesTheSameBytesAsReadingTheFiles) {
  const World files = opened_without_cache(spec_);
  EXPECT_EQ(files.cache, "none");
  const BuildReport report = build();
  EXPECT_FALSE(report.was_fresh);
  EXPECT_GT(report.chunks_made, 0);
  EXPECT_EQ(report.folder.parent_path(), folder_.path() / "world.cache");
  const World built = opened(spec_);
  EXPECT_THAT(built.cache, HasSubstr("in use: "));
  expect_same_tiles(files, built);
  expect_same_ground(files, built);
  EXPECT_EQ(built.warnings, files.warnings);
  EXPECT_EQ(built.data_hashes, files.data_hashes);
  EXPECT_TRUE(built.tiles->status());
}

TEST_F(BuiltWorld, HasNothingToDoTheSecondTime) {
  const BuildReport second = build();
  EXPECT_TRUE(second.was_fresh);
  EXPECT_EQ(second.chunks_made, 0);
  EXPECT_EQ(second.folder, cache_);
  EXPECT_EQ(second.bytes, report_.bytes);
}

TEST_F(BuildWorld, StopsWhenToldToAndIsNoCacheUntilItIsWhole) {
  std::vector<std::string> heard;
  const auto stopped = build_world(spec_, [&](double share, const std::string& doing) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    heard.push_back(doing);
    return doing.find("chunks") == std::string::npos;
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_THAT(heard, ::testing::Contains(HasSubstr("reading near.tif")));
  EXPECT_EQ(opened(spec_).cache, "none");
}

TEST_F(BuiltWorld, DoesOnlyTheRestAfterTheDiskWasFull) {
  const World files = opened_without_cache(spec_);
  fs::path largest;
  for (const fs::path& file : chunks_below(cache_)) {
    if (largest.empty() || fs::file_size(file) > fs::file_size(largest)) largest = file;
  }
  const auto size = fs::file_size(largest);
  fs::remove(largest);
  fs::remove(cache_ / "cache.json");

  // Files larger than this cannot be written: a full disk for this process only.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = size - 1;
  std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto full = build_world(spec_);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_DFL);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::kIo);
  EXPECT_THAT(full.error().message, HasSubstr(largest.filename().string()));
  EXPECT_THAT(full.error().message, HasSubstr("cannot be written: File too large"));
  EXPECT_EQ(opened(spec_).cache, "none") << "half a cache must not be used";

  const BuildReport rest = build();
  EXPECT_EQ(rest.chunks_made, 1);
  EXPECT_EQ(rest.chunks_kept, report_.chunks_made - 1);
  expect_same_tiles(files, opened(spec_));
}

TEST_F(BuildWorld, LeavesARightCacheWhenTwoProcessesBuildAtOnce) {
  std::vector<pid_t> children;
  for (int i = 0; i < 2; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(build_world(spec_) ? 0 : 1);
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  const World built = opened(spec_);
  EXPECT_THAT(built.cache, HasSubstr("in use"));
  expect_same_tiles(opened_without_cache(spec_), built);
  EXPECT_EQ(std::distance(fs::directory_iterator(spec_.cache_folder), {}), 1);
}

TEST_F(BuiltWorld, GoesOnAfterItWasKilledInTheMiddleOfWriting) {
  const fs::path largest = cache_ / "tiles/0/x0y0.chunk";
  const auto size = fs::file_size(largest);
  const std::string bytes = testing::read_text(largest);
  fs::remove(largest);
  fs::remove(cache_ / "tiles/1/x0y0.chunk");
  fs::remove(cache_ / "cache.json");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // The signal of a file that grows too large ends the process within the write.
    const rlimit small{size / 2, size / 2};
    setrlimit(RLIMIT_FSIZE, &small);
    std::signal(SIGXFSZ, SIG_DFL);
    _exit(build_world(spec_) ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  EXPECT_EQ(opened(spec_).cache, "none");
  EXPECT_FALSE(fs::exists(largest)) << "half a file";
  const BuildReport report = build();
  EXPECT_GE(report.chunks_kept, report_.chunks_made - 2);
  EXPECT_EQ(report.chunks_kept + report.chunks_made, report_.chunks_made);
  EXPECT_EQ(testing::read_text(largest), bytes);
}

TEST_F(BuiltWorld, NoticesAChangedFileAndIsMadeAgain) {
  TemporaryFolder elsewhere;
  (void)testing::write_layered_world(elsewhere.path(), {77, -1});
  fs::copy_file(elsewhere.path() / "near.tif",
                folder_.path() / "near.tif",
                fs::copy_options::overwrite_existing);
  const World changed = opened(spec_);
  EXPECT_THAT(changed.cache, HasSubstr("stale: near.tif has "));
  EXPECT_THAT(changed.warnings, ::testing::Contains(HasSubstr("Run `overfly world build`")));
  expect_same_tiles(opened_without_cache(spec_), changed);
  const BuildReport after = build();
  EXPECT_NE(after.folder, cache_);
  EXPECT_FALSE(fs::exists(cache_)) << "the old cache is of no use to anybody";
  EXPECT_THAT(opened(spec_).cache, HasSubstr("in use"));
}

TEST_F(BuiltWorld, NoticesAChangeThatKeepsSizeAndSaysWhich) {
  const fs::path file = folder_.path() / "far_heights.tif";
  flip_byte(file, fs::file_size(file) - 40);
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(5));
  EXPECT_EQ(opened(spec_).cache, "stale: far_heights.tif has changed");
}

TEST_F(BuiltWorld, IsStillGoodWhenAFileWasOnlyCopied) {
  const fs::path file = folder_.path() / "near.tif";
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::hours(1));
  EXPECT_THAT(opened(spec_).cache, HasSubstr("in use"));
  EXPECT_TRUE(build().was_fresh);
}

TEST_F(BuildWorld, NoticesAChangeBetweenTheSamplesOfALargeFile) {
  const fs::path file = folder_.path() / "near.tif";
  fs::resize_file(file, std::uintmax_t{33} << 20U);  // above 32 MiB only samples are digested
  const BuildReport first = build();
  EXPECT_THAT(opened(spec_).cache, HasSubstr("in use"));
  const auto time = fs::last_write_time(file);
  {
    std::fstream between(file, std::ios::in | std::ios::out | std::ios::binary);
    between.seekp((std::streamoff{1} << 20U) + 100);  // after the first of 32 samples of 1 MiB
    between.put('x');
  }
  fs::last_write_time(file, time + std::chrono::seconds(5));
  EXPECT_EQ(opened(spec_).cache, "stale: near.tif has another modification time");
  EXPECT_NE(build().folder, first.folder);
}

TEST_F(BuiltWorld, NoticesAChangedManifestButNotItsWords) {
  WorldSpec spec = spec_;
  spec.name = "Another name";
  spec.imagery[0].attribution = "Somebody";
  EXPECT_THAT(opened(spec).cache, HasSubstr("in use"));
  spec.elevation[1].geoid_separation_m = 1.0;
  spec.elevation[1].datum = VerticalDatum::kUnknown;
  EXPECT_EQ(opened(spec).cache, "stale: the manifest has changed");
  spec = spec_;
  std::swap(spec.imagery[0], spec.imagery[1]);
  EXPECT_EQ(opened(spec).cache, "stale: the manifest has changed");
}

TEST_F(BuildWorld, LeavesOtherFilesInItsFolderAlone) {
  fs::create_directories(spec_.cache_folder / "0123456789abcdef");
  testing::write_text(spec_.cache_folder / "0123456789abcdef" / "diary.txt", "mine");
  testing::write_text(spec_.cache_folder / "notes.txt", "mine too");
  (void)build();
  EXPECT_TRUE(fs::exists(spec_.cache_folder / "0123456789abcdef" / "diary.txt"));
  EXPECT_TRUE(fs::exists(spec_.cache_folder / "notes.txt"));
}

TEST_F(BuiltWorld, MayBeMovedTogetherWithItsFiles) {
  TemporaryFolder elsewhere;
  fs::copy(folder_.path(), elsewhere.path() / "moved", fs::copy_options::recursive);
  const World moved = opened(spec_of(elsewhere.path() / "moved" / "world.json"));
  EXPECT_THAT(moved.cache, HasSubstr("in use"));
}

TEST_F(BuildWorld, NeedsAPlaceForTheCache) {
  spec_.cache_folder.clear();
  const auto report = build_world(spec_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(report.error().message, HasSubstr("no manifest"));
}

}  // namespace
}  // namespace overfly::terrain
