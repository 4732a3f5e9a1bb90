#include "core/outside/forward_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/support.hpp"

namespace overfly {
namespace {

/// Text whose bytes differ from place to place.
std::string long_text(std::size_t size) {
  std::string text(size, ' ');
  for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>((i * 31 + i / 251) & 0xFFU);
  return text;
}

TEST(ForwardReader, ReadsAFileLargerThanItsBuffer) {
  const testing::TemporaryFolder folder;
  const std::string text = long_text(2 * ForwardReader::kBufferBytes + 12345);
  testing::write_text(folder.path() / "a", text);
  Result<ForwardReader> reader = ForwardReader::open(folder.path() / "a");
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader->size_bytes(), text.size());
  std::string read;
  while (true) {
    EXPECT_EQ(reader->position(), read.size());
    const auto bytes = reader->ahead(1000);
    ASSERT_TRUE(bytes.ok());
    if (bytes->empty()) break;
    if (read.size() + 1000 <= text.size()) {
      EXPECT_GE(bytes->size(), 1000U);
    }
    const std::size_t taken = std::min<std::size_t>(bytes->size(), 777);
    read.append(reinterpret_cast<const char*>(bytes->data()), taken);
    reader->skip(taken);
  }
  EXPECT_EQ(read, text);
}

TEST(ForwardReader, ReadsPartsAsOneFile) {
  const testing::TemporaryFolder folder;
  const std::size_t block = ForwardReader::kBufferBytes;
  const std::string text = long_text(4 * block);
  testing::write_text(folder.path() / "a", text);
  Result<ForwardReader> reader = ForwardReader::open(folder.path() / "a");
  ASSERT_TRUE(reader.ok());
  ASSERT_TRUE(reader->ahead(1000).ok());
  reader->skip(1000);
  // The last part reaches behind the end of the file, and one is empty.
  reader->only({{10, 30}, {100, 100}, {block, 3 * block + 5}, {4 * block - 7, 9 * block}});
  const std::string expected =
      text.substr(10, 20) + text.substr(block, 2 * block + 5) + text.substr(4 * block - 7);
  EXPECT_EQ(reader->size_bytes(), expected.size());
  std::string read;
  while (true) {
    EXPECT_EQ(reader->position(), read.size());
    const auto bytes = reader->ahead(1000);
    ASSERT_TRUE(bytes.ok());
    if (bytes->empty()) break;
    EXPECT_EQ(static_cast<char>(bytes->front()), text[reader->file_offset()]);
    const std::size_t taken = std::min<std::size_t>(bytes->size(), 777);
    read.append(reinterpret_cast<const char*>(bytes->data()), taken);
    reader->skip(taken);
  }
  EXPECT_EQ(read, expected);
}

TEST(ForwardReader, EndsEarlyWhereTheFileWasShortened) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a";
  testing::write_text(file, long_text(3 * ForwardReader::kBufferBytes));
  Result<ForwardReader> reader = ForwardReader::open(file);
  ASSERT_TRUE(reader.ok());
  ASSERT_TRUE(reader->ahead(1).ok());
  std::filesystem::resize_file(file, ForwardReader::kBufferBytes + 10);
  reader->skip(ForwardReader::kBufferBytes);
  const auto bytes = reader->ahead(1000);
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ(bytes->size(), 10U);
  reader->skip(10);
  EXPECT_TRUE(reader->ahead(1)->empty());
}

TEST(ForwardReader, DoesNotReadWhatIsAppendedLater) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a";
  testing::write_text(file, "12345");
  Result<ForwardReader> reader = ForwardReader::open(file);
  ASSERT_TRUE(reader.ok());
  testing::write_text(file, "1234567890");
  EXPECT_EQ(reader->ahead(100)->size(), 5U);
}

TEST(ForwardReader, OpensRegularFilesOnly) {
  const testing::TemporaryFolder folder;
  EXPECT_EQ(ForwardReader::open(folder.path() / "absent").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(ForwardReader::open(folder.path()).error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace overfly
