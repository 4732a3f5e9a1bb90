// JPEG, whole files, lines, schemas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "server/files/jpeg.hpp"
#include "server/files/json_schema.hpp"
#include "server/files/take_name.hpp"
#include "server/files/whole_file.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

Image gradient(int channels) {
  Image image(64, 48, channels);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>(2 * x + y + 20 * c);
      }
    }
  }
  return image;
}

TEST(TakeName, DoesNotReplaceAFile) {
  const TemporaryFolder folder;
  const std::filesystem::path part = folder.path() / "part";
  const std::filesystem::path name = folder.path() / "name";
  overfly::testing::write_text(part, "new");
  const auto taken = take_free_name(part, name);
  ASSERT_TRUE(taken.ok() && *taken);
  EXPECT_FALSE(std::filesystem::exists(part));
  overfly::testing::write_text(part, "newer");
  const auto again = take_free_name(part, name);
  ASSERT_TRUE(again.ok());
  EXPECT_FALSE(*again);
  EXPECT_EQ(overfly::testing::read_text(name), "new");
  EXPECT_EQ(take_free_name(folder.path() / "none", folder.path() / "other").error().code,
            ErrorCode::kIo);
}

/// Folders have no hard links, as no file of some file systems has.
TEST(TakeName, WorksWithoutHardLinks) {
  const TemporaryFolder folder;
  for (const char* name : {"part", "part2"}) {
    std::filesystem::create_directory(folder.path() / name);
  }
  const auto taken = take_free_name(folder.path() / "part", folder.path() / "name");
  ASSERT_TRUE(taken.ok()) << taken.error().message;
  EXPECT_TRUE(*taken);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "name"));
  const auto again = take_free_name(folder.path() / "part2", folder.path() / "name");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_FALSE(*again);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "part2"));
}

TEST(TakeName, WorksWhereNothingRenamesWithoutReplacing) {
  const TemporaryFolder folder;
  for (const char* kind : {"file", "folder"}) {
    const std::filesystem::path name = folder.path() / kind;
    for (const char* part : {"part", "part2"}) {
      const std::filesystem::path content =
          std::string(kind) == "file" ? folder.path() / part : folder.path() / part / "a";
      std::filesystem::create_directories(content.parent_path());
      overfly::testing::write_text(content, part);
      const auto taken = take_reserved_name(folder.path() / part, name);
      ASSERT_TRUE(taken.ok()) << taken.error().message;
      EXPECT_EQ(*taken, std::string(part) == "part") << kind;
      EXPECT_NE(std::filesystem::exists(content), *taken);
    }
    EXPECT_EQ(overfly::testing::read_text(std::string(kind) == "file" ? name
                                                                      : folder.path() / kind / "a"),
              "part");
    std::filesystem::remove_all(folder.path() / "part2");
  }
  EXPECT_EQ(take_reserved_name(folder.path() / "none", folder.path() / "other").error().code,
            ErrorCode::kIo);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "other"));
}

TEST(Jpeg, KeepsSizeChannelsAndNearlyTheValues) {
  for (const int channels : {1, 3}) {
    const Image image = gradient(channels);
    const auto bytes = encode_jpeg(image, 95);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    const auto decoded = decode_jpeg(*bytes);
    ASSERT_TRUE(decoded.ok()) << decoded.error().message;
    ASSERT_EQ(decoded->width_px, 64);
    ASSERT_EQ(decoded->height_px, 48);
    ASSERT_EQ(decoded->channels, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) {
      EXPECT_NEAR(decoded->data[i], image.data[i], 6);  // smooth content at quality 95
    }
  }
}

TEST(Jpeg, RefusesBadQualityEmptyImagesAndOtherBytes) {
  EXPECT_THAT(encode_jpeg(gradient(1), 0).error().message, HasSubstr("must be in [1, 100]"));
  EXPECT_EQ(encode_jpeg(Image(), 75).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(encode_jpeg(Image(4, 4, 2), 75).error().code, ErrorCode::kInvalidArgument);
  const std::vector<std::uint8_t> noise = {1, 2, 3, 4};
  EXPECT_EQ(decode_jpeg(noise).error().code, ErrorCode::kUnreadable);
}

TEST(WholeFile, ReplacesAndLeavesNoPart) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.txt";
  ASSERT_TRUE(write_whole(file, std::string("one")).ok());
  ASSERT_TRUE(write_whole(file, std::string("two")).ok());
  EXPECT_EQ(overfly::testing::read_text(file), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  const auto nowhere = write_whole(folder.path() / "no" / "a.txt", std::string("x"));
  EXPECT_EQ(nowhere.error().code, ErrorCode::kIo);
  EXPECT_THAT(nowhere.error().message, HasSubstr("No such file"));
}

/// A folder that came from elsewhere may have anything in place of the temporary file.
TEST(WholeFile, WritesThroughNoLinkAndWaitsForNoReader) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.txt";
  const auto part = folder.path() / "a.txt.part";
  const auto elsewhere = folder.path() / "elsewhere";
  overfly::testing::write_text(elsewhere, "kept");
  std::filesystem::create_symlink(elsewhere, part);
  ASSERT_TRUE(write_whole(file, std::string("one")).ok());
  EXPECT_EQ(overfly::testing::read_text(elsewhere), "kept");
  EXPECT_FALSE(std::filesystem::is_symlink(file));
  ASSERT_EQ(::mkfifo(part.c_str(), 0600), 0);
  ASSERT_TRUE(write_whole(file, std::string("two")).ok());
  EXPECT_EQ(overfly::testing::read_text(file), "two");
  std::filesystem::create_directory(part);
  EXPECT_EQ(write_whole(file, std::string("three")).error().code, ErrorCode::kIo);
}

TEST(LineFile, IsReadInPieces) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.jsonl";
  constexpr std::size_t kRows = 3000;
  std::string text;
  for (std::size_t i = 0; i < kRows; ++i) {
    text += "{\"i\":" + std::to_string(i) + ",\"text\":\"" + std::string(1000, 'x') + "\"}\n";
  }
  overfly::testing::write_text(file, text);
  const auto lines = read_lines(file);
  ASSERT_TRUE(lines.ok()) << lines.error().message;
  ASSERT_EQ(lines->size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) ASSERT_EQ((*lines)[i].at("i"), i);
  overfly::testing::write_text(file, "{}\n\"" + std::string(2U << 20U, 'x') + "\"\n");
  EXPECT_EQ(read_lines(file).error().code, ErrorCode::kUnreadable);
  EXPECT_THAT(read_lines(file).error().message, HasSubstr("row 2: is longer than 1048576 bytes"));
}

TEST(LineFile, IsReadBackWithoutTheLineThatAKillCutShort) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.jsonl";
  {
    LineFile lines = std::move(LineFile::create(file)).value();
    ASSERT_TRUE(lines.append({{"a", 1}}).ok());
    ASSERT_TRUE(lines.append({{"a", 0.1}}).ok());
  }
  EXPECT_FALSE(LineFile::create(file).ok()) << "never writes into a file that is there";
  const std::string text = overfly::testing::read_text(file);
  overfly::testing::write_text(file, text + "{\"a\": 3");
  const auto lines = read_lines(file);
  ASSERT_TRUE(lines.ok()) << lines.error().message;
  ASSERT_EQ(lines->size(), 2U);
  EXPECT_EQ((*lines)[1].at("a").get<double>(), 0.1);
  EXPECT_TRUE(read_lines(folder.path() / "none").value().empty());
  overfly::testing::write_text(file, "{\"a\": 1}\n{a}\n");
  EXPECT_THAT(read_lines(file).error().message, HasSubstr("row 2"));
}

TEST(WholeFile, GivesReadErrorsAsErrors) {
  for (const Error& error :
       {read_json("/proc/self/mem").error(), read_lines("/proc/self/mem").error()}) {
    EXPECT_EQ(error.code, ErrorCode::kIo);
    EXPECT_THAT(error.message, HasSubstr("/proc/self/mem: reading failed"));
  }
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(read_json(file).error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(read_lines(file).error().code, ErrorCode::kUnreadable);
  overfly::testing::write_text(folder.path() / "b.json", "{}");
  std::filesystem::resize_file(folder.path() / "b.json", 20'000'000'000U);
  EXPECT_THAT(read_json(folder.path() / "b.json").error().message, HasSubstr("must have at most"));
}

TEST(WholeFile, RefusesDeepJson) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  overfly::testing::write_text(file, deep);
  EXPECT_THAT(read_json(file).error().message, HasSubstr("a.json: is nested more than 64 deep"));
  overfly::testing::write_text(file, "{}\n" + deep + "\n");
  EXPECT_THAT(read_lines(file).error().message, HasSubstr("row 2: is nested more than 64 deep"));
}

TEST(JsonSchema, NamesBranchesWithoutTitlesAndUnknownFields) {
  const JsonSchema schema(nlohmann::json::parse(R"({"oneOf": [
    {"type": "object", "required": ["a"], "properties": {"a": {}, "more": {}}},
    {"type": "object", "title": "b with c", "required": ["b", "c"], "properties": {"b": {}, "c": {}}},
    {"type": "number"}]})"));
  const auto fault = [&](const char* document) {
    const auto violations = schema.violations(nlohmann::json::parse(document));
    return violations.empty() ? "" : violations.front().text;
  };
  EXPECT_EQ(fault(R"({"b": 1, "d": 2})"),
            R"(the document = {"b":1,"d":2}: must be exactly one of {a}, b with c, number )"
            "(unknown: d)");
  EXPECT_EQ(fault("true"), "the document = true: must be exactly one of {a}, b with c, number");
  EXPECT_EQ(fault(R"({"a": 1})"), "");
}

}  // namespace
}  // namespace overfly::server
