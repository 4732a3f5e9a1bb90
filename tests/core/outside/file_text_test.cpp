#include "core/outside/file_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/support.hpp"

namespace overfly {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::write_text;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

TEST(FileText, ReadsAFileWholeUpToItsLimit) {
  const TemporaryFolder folder;
  std::string text(3 * kMiB + 17, 'a');
  text[kMiB] = '\0';
  write_text(folder.path() / "a", text);
  EXPECT_EQ(read_file_text(folder.path() / "a", text.size()).value(), text);
  write_text(folder.path() / "empty", "");
  EXPECT_EQ(read_file_text(folder.path() / "empty", 0).value(), "");
  fs::create_symlink(folder.path() / "a", folder.path() / "link");
  EXPECT_EQ(read_file_text(folder.path() / "link", text.size()).value(), text);
}

TEST(FileText, RefusesAFileBeyondItsLimitUnread) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "sparse";
  write_text(file, "");
  fs::resize_file(file, 20'000'000'000U);
  const auto text = read_file_text(file, kMiB);
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(text.error().message,
            file.string() + ": has 20000000000 bytes: must have at most 1048576");
}

TEST(FileText, NeverWaitsForAFifo) {
  const TemporaryFolder folder;
  const fs::path fifo = folder.path() / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const auto text = read_file_text(fifo, kMiB);
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(text.error().message, fifo.string() + ": is not a regular file");
}

TEST(FileText, GivesEveryFailureAsAnErrorThatNamesTheFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_file_text(folder.path() / "none", 1).error().code, ErrorCode::kNotFound);
  write_text(folder.path() / "a", "a");
  EXPECT_EQ(read_file_text(folder.path() / "a" / "b", 1).error().code, ErrorCode::kNotFound);
  EXPECT_THAT(read_file_text(folder.path(), 1).error().message, HasSubstr("is a folder"));
  EXPECT_EQ(read_file_text("/dev/zero", 1).error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(read_file_text(std::string(5000, 'x'), 1).error().code, ErrorCode::kIo);
  // A regular file that reports size 0 and gives an I/O error at the first byte.
  const auto memory = read_file_text("/proc/self/mem", kMiB);
  ASSERT_FALSE(memory.ok());
  EXPECT_EQ(memory.error().code, ErrorCode::kIo);
  EXPECT_EQ(memory.error().message, "/proc/self/mem: reading failed: Input/output error");
}

TEST(FileText, BoundsFilesThatSayTheyAreEmpty) {
  EXPECT_GT(read_file_text("/proc/self/stat", kMiB)->size(), 10U);
  EXPECT_THAT(read_file_text("/proc/self/stat", 10).error().message, HasSubstr("at most 10"));
}

TEST(FileText, StopsWhenCancelled) {
  const TemporaryFolder folder;
  write_text(folder.path() / "a", "abc");
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(read_file_text(folder.path() / "a", 10, &cancel).error().code, ErrorCode::kCancelled);
}

TEST(ReadableFile, ReadsAnyPartAndSeesTheFileGrow) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "f";
  std::ofstream(file) << "0123456789";
  const auto open = ReadableFile::open(file);
  ASSERT_TRUE(open.ok()) << open.error().message;
  EXPECT_EQ(open->size_bytes().value(), 10U);
  std::vector<std::uint8_t> bytes(4);
  ASSERT_TRUE(open->read_at(6, bytes).ok());
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "6789");
  const Status beyond = open->read_at(8, bytes);
  ASSERT_FALSE(beyond.ok());
  EXPECT_EQ(beyond.error().code, ErrorCode::kIo);
  EXPECT_THAT(beyond.error().message, HasSubstr("ends at byte 10"));
  std::ofstream(file, std::ios::app) << "ab";
  EXPECT_EQ(open->size_bytes().value(), 12U);
  ASSERT_TRUE(open->read_at(8, bytes).ok());
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "89ab");
  EXPECT_EQ(ReadableFile::open("/dev/null").error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(ReadableFile::open(folder.path() / "none").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace overfly
