// The folder of a frame cache: its budget, its order, several processes, kills and full disks.
#include "server/frame_cache/frame_folder.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "core/measure/sha256.hpp"
#include "core/time.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Added = FrameFolder::Added;
using ::testing::HasSubstr;

constexpr std::int64_t kLongAgo_ns = 1'000'000'000 * kNsPerS;
constexpr std::int64_t kNever_ns = 4'000'000'000 * kNsPerS;
constexpr std::size_t kMost = 1U << 20U;

std::string key_of(int number) {
  const std::string text = std::to_string(number);
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::vector<std::uint8_t> bytes_for(int number, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + number);
  return bytes;
}

struct Files {
  std::uint64_t bytes = 0;
  int count = 0;
  int parts = 0;
};

Files files_in(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".frame")) ++files.count;
    if (name.ends_with(".part")) ++files.parts;
    if (!name.ends_with(".frame") && !name.ends_with(".part")) continue;
    // Another process may rename or remove it meanwhile.
    std::error_code gone;
    const std::uint64_t size = entry.file_size(gone);
    if (!gone) files.bytes += size;
  }
  return files;
}

class FrameFolderTest : public ::testing::Test {
 protected:
  FrameFolder open(std::uint64_t budget_bytes, std::int64_t keep_since_ns = kNever_ns) {
    FrameFolder folder({folder_.path() / "cache", budget_bytes, keep_since_ns, 0});
    EXPECT_TRUE(folder.create().ok());
    return folder;
  }
  [[nodiscard]] fs::path path() const { return folder_.path() / "cache"; }
  /// Makes a picture seem to have been used at a time.
  static void set_used(const FrameFolder& folder, int number, std::int64_t unix_s) {
    const timespec times[2] = {{unix_s, 0}, {unix_s, 0}};
    ASSERT_EQ(::utimensat(AT_FDCWD, folder.file_of(key_of(number)).c_str(), times, 0), 0);
  }
  static bool has(const FrameFolder& folder, int number) { return folder.is_known(key_of(number)); }

 private:
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(FrameFolderTest, GivesBackWhatWasAdded) {
  FrameFolder folder = open(kMost);
  EXPECT_FALSE(folder.read(key_of(1), kMost)->has_value());
  ASSERT_EQ(folder.add(key_of(1), bytes_for(1, 1000)).value(), Added::kAdded);
  EXPECT_EQ(folder.add(key_of(1), bytes_for(1, 1000)).value(), Added::kKnown);
  EXPECT_EQ(folder.read(key_of(1), kMost)->value(), bytes_for(1, 1000));
  // Another process that opens it later.
  EXPECT_EQ(open(0).read(key_of(1), kMost)->value(), bytes_for(1, 1000));
  EXPECT_FALSE(folder.read(key_of(2), kMost)->has_value());
  const auto large = folder.read(key_of(1), 999);
  ASSERT_FALSE(large.ok());
  EXPECT_EQ(large.error().code, ErrorCode::kUnreadable);
  folder.remove(key_of(1));
  EXPECT_FALSE(folder.read(key_of(1), kMost)->has_value());
  EXPECT_TRUE(fs::exists(path() / "CACHEDIR.TAG"));
}

TEST_F(FrameFolderTest, RemovesThePicturesThatWereUsedLongestAgo) {
  FrameFolder folder = open(10'000);
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(folder.add(key_of(i), bytes_for(i, 1000)).value(), Added::kAdded);
    set_used(folder, i, 1000 + i);
  }
  // Reading is a use.
  ASSERT_TRUE(folder.read(key_of(0), kMost)->has_value());
  ASSERT_EQ(folder.add(key_of(10), bytes_for(10, 1000)).value(), Added::kAdded);
  EXPECT_TRUE(has(folder, 0));
  EXPECT_FALSE(has(folder, 1));
  EXPECT_TRUE(has(folder, 9));
  EXPECT_TRUE(has(folder, 10));
  EXPECT_LE(files_in(path()).bytes, 10'000U);
  EXPECT_GE(files_in(path()).count, 9);
}

TEST_F(FrameFolderTest, NeverRemovesPicturesOfTheSameSeries) {
  FrameFolder folder = open(5'000, kLongAgo_ns);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(folder.add(key_of(i), bytes_for(i, 1000)).value(), Added::kAdded);
  }
  EXPECT_EQ(folder.add(key_of(5), bytes_for(5, 1000)).value(), Added::kNoRoom);
  EXPECT_EQ(files_in(path()).count, 5);
  EXPECT_EQ(files_in(path()).parts, 0);
  EXPECT_EQ(folder.add(key_of(6), bytes_for(6, 5001)).value(), Added::kNoRoom) << "too large";
  // A later series.
  FrameFolder later = open(5'000, kNever_ns);
  EXPECT_EQ(later.add(key_of(5), bytes_for(5, 1000)).value(), Added::kAdded);
}

TEST_F(FrameFolderTest, ASmallerBudgetShrinksTheFolder) {
  FrameFolder folder = open(100'000);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(folder.add(key_of(i), bytes_for(i, 1000)).ok());
  FrameFolder small = open(10'000);
  ASSERT_EQ(small.add(key_of(99), bytes_for(99, 1000)).value(), Added::kAdded);
  EXPECT_LE(files_in(path()).bytes, 10'000U);
  EXPECT_TRUE(has(small, 99));
}

TEST_F(FrameFolderTest, ALedgerThatIsLostOrDamagedIsCountedAgain) {
  FrameFolder folder = open(10'000);
  for (int i = 0; i < 9; ++i) ASSERT_TRUE(folder.add(key_of(i), bytes_for(i, 1000)).ok());
  for (const char* content : {"", "nonsense that is longer than two numbers"}) {
    overfly::testing::write_text(path() / "ledger", content);
    ASSERT_TRUE(folder.add(key_of(100), bytes_for(100, 900)).ok());
    EXPECT_LE(files_in(path()).bytes, 10'000U);
    folder.remove(key_of(100));
  }
  // It says less than there is only if somebody writes to it; more, after kills: both are
  // corrected.
  const std::uint64_t full[2] = {10'000, ~std::uint64_t{10'000}};
  overfly::testing::write_text(path() / "ledger",
                               std::string(reinterpret_cast<const char*>(full), sizeof full));
  EXPECT_EQ(folder.add(key_of(101), bytes_for(101, 900)).value(), Added::kAdded);
  EXPECT_GE(files_in(path()).count, 9);
}

TEST_F(FrameFolderTest, LeavesOtherFilesAlone) {
  FrameFolder folder = open(3'000);
  overfly::testing::write_text(path() / "precious.txt", std::string(5000, 'x'));
  fs::create_directory(path() / "photos");
  overfly::testing::write_text(path() / "photos" / "a.jpg", std::string(5000, 'x'));
  fs::create_symlink(path() / "precious.txt", path() / "photos" / "link.frame");
  for (int i = 0; i < 9; ++i) {
    ASSERT_EQ(folder.add(key_of(i), bytes_for(i, 1000)).value(), Added::kAdded);
  }
  EXPECT_TRUE(fs::exists(path() / "precious.txt"));
  EXPECT_TRUE(fs::exists(path() / "photos" / "a.jpg"));
  EXPECT_TRUE(fs::is_symlink(path() / "photos" / "link.frame"));
}

TEST_F(FrameFolderTest, RemovesWhatAKilledProcessLeftInTheWriting) {
  FrameFolder folder = open(4'000);
  ASSERT_TRUE(folder.add(key_of(1), bytes_for(1, 1000)).ok());
  const fs::path old_part = folder.file_of(key_of(1)).string() + ".123-4.part";
  const fs::path new_part = folder.file_of(key_of(1)).string() + ".123-5.part";
  overfly::testing::write_text(old_part, std::string(1500, 'x'));
  overfly::testing::write_text(new_part, std::string(500, 'x'));
  const timespec times[2] = {{1000, 0}, {1000, 0}};
  ASSERT_EQ(::utimensat(AT_FDCWD, old_part.c_str(), times, 0), 0);
  for (int i = 2; i < 6; ++i) ASSERT_TRUE(folder.add(key_of(i), bytes_for(i, 1000)).ok());
  EXPECT_FALSE(fs::exists(old_part));
  EXPECT_TRUE(fs::exists(new_part)) << "another process may be writing it";
  EXPECT_LE(files_in(path()).bytes, 4'000U);
}

TEST_F(FrameFolderTest, LeavesRoomOnTheDisk) {
  FrameFolder folder({path(), kMost, 0, std::uint64_t{1} << 62U});
  ASSERT_TRUE(folder.create().ok());
  const auto added = folder.add(key_of(1), bytes_for(1, 10));
  ASSERT_FALSE(added.ok());
  EXPECT_THAT(added.error().message, HasSubstr("MiB are left on its disk"));
  EXPECT_EQ(files_in(path()).count, 0);
}

TEST_F(FrameFolderTest, AFullDiskLeavesNoPictureInParts) {
  fs::create_directories(path());
  if (::mount("tmpfs", path().c_str(), "tmpfs", 0, "size=1m,nr_inodes=14") != 0) {
    GTEST_SKIP() << "file systems cannot be mounted here";
  }
  {
    FrameFolder folder = open(kMost);
    Result<Added> added = Added::kAdded;
    int count = 0;
    while (added && count < 30) {
      added = folder.add(key_of(count), bytes_for(count, 20'000));
      ++count;
    }
    ASSERT_FALSE(added.ok());
    EXPECT_THAT(added.error().message, HasSubstr("No space left on device"));
    EXPECT_GT(count, 3);
    EXPECT_EQ(files_in(path()).parts, 0);
    for (int i = 0; i + 1 < count; ++i) {
      EXPECT_EQ(folder.read(key_of(i), kMost)->value(), bytes_for(i, 20'000));
    }
  }
  ASSERT_EQ(::umount2(path().c_str(), MNT_DETACH), 0);
}

TEST_F(FrameFolderTest, AFolderThatCannotBeMadeIsNamed) {
  overfly::testing::write_text(path(), "a file");
  const Status created = FrameFolder({path() / "below", kMost, 0, 0}).create();
  ASSERT_FALSE(created.ok());
  EXPECT_THAT(created.error().message, HasSubstr(path().string()));
}

/// Adds pictures in another process until it is killed or has added all of them.
pid_t start_adding(const fs::path& path, std::uint64_t budget_bytes, int first, int count) {
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  FrameFolder folder({path, budget_bytes, kNever_ns, 0});
  for (int i = first; i < first + count; ++i) {
    if (!folder.add(key_of(i), bytes_for(i, 500 + 37 * (i % 40)))) ::_exit(1);
    const auto read = folder.read(key_of(i), kMost);
    // Another process may have removed it; what is there is whole.
    if (!read || (*read && **read != bytes_for(i, 500 + 37 * (i % 40)))) ::_exit(2);
  }
  ::_exit(0);
}

TEST_F(FrameFolderTest, SeveralProcessesKeepTheBudgetAtEveryInstant) {
  constexpr std::uint64_t kBudget = 60'000;
  FrameFolder folder = open(kBudget);
  std::vector<pid_t> processes;
  // Half of the pictures are those of another process too.
  for (int i = 0; i < 4; ++i) {
    processes.push_back(start_adding(path(), kBudget, 75 * i, 150));
  }
  std::uint64_t most_bytes = 0;
  std::size_t ended = 0;
  while (ended < processes.size()) {
    most_bytes = std::max(most_bytes, files_in(path()).bytes);
    int status = 0;
    if (::waitpid(-1, &status, WNOHANG) <= 0) continue;
    EXPECT_EQ(status, 0);
    ++ended;
  }
  EXPECT_LE(files_in(path()).bytes, kBudget);
  EXPECT_GT(files_in(path()).bytes, kBudget / 2);
  EXPECT_EQ(files_in(path()).parts, 0);
  // A walk through the folder is no instant: it may count a picture that was removed meanwhile and
  // the one that took its place.
  EXPECT_LE(most_bytes, 2 * kBudget);
}

TEST_F(FrameFolderTest, AKilledProcessLeavesNoPictureInParts) {
  constexpr std::uint64_t kBudget = 200'000;
  FrameFolder folder = open(kBudget);
  for (int round = 0; round < 10; ++round) {
    const int first = 10'000 * round;
    const pid_t pid = start_adding(path(), kBudget, first, 10'000);
    const int before = files_in(path()).count;
    while (files_in(path()).count < before + 3 && files_in(path()).bytes < kBudget / 2) {
      ASSERT_EQ(::waitpid(pid, nullptr, WNOHANG), 0);
    }
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
  }
  int whole = 0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 10'000 * round; i < 10'000 * (round + 1); ++i) {
      const auto read = folder.read(key_of(i), kMost);
      ASSERT_TRUE(read.ok());
      if (!*read) continue;
      ++whole;
      EXPECT_EQ(**read, bytes_for(i, 500 + 37 * (i % 40)));
    }
  }
  EXPECT_GT(whole, 10);
  // The lock of a killed process is free.
  EXPECT_EQ(folder.add(key_of(-1), bytes_for(1, 1000)).value(), Added::kAdded);
  EXPECT_LE(files_in(path()).bytes, kBudget);
}

}  // namespace
}  // namespace overfly::server
