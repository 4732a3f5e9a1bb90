#include "core/outside/source_policy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/support.hpp"

namespace overfly {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::write_text;

/// data/ with a.tif, sub/b.tif, fifo and links; next to it secret/s.tif and data2/x.tif.
class SourcePolicyTest : public ::testing::Test {
 protected:
  SourcePolicyTest() {
    for (const char* folder : {"data/sub", "data/runs/one", "secret", "data2"}) {
      fs::create_directories(root() / folder);
    }
    for (const char* file : {"data/a.tif",
                             "data/sub/b.tif",
                             "data/runs/one/scenario.json",
                             "secret/s.tif",
                             "data2/x"}) {
      write_text(root() / file, "x");
    }
    EXPECT_EQ(::mkfifo((root() / "data/fifo").c_str(), 0600), 0);
    fs::create_symlink("a.tif", root() / "data/inner");
    fs::create_symlink(root() / "secret/s.tif", root() / "data/outer");
    fs::create_symlink(root() / "secret/none.tif", root() / "data/dead");
    fs::create_directory_symlink(root() / "secret", root() / "data/folder");
    fs::create_directory_symlink(root() / "data", root() / "other_name");
  }

  [[nodiscard]] const fs::path& root() const { return folder_.path(); }
  [[nodiscard]] SourcePolicy policy() const {
    return SourcePolicy::inside({root() / "data", root() / "absent"}, {root() / "data/runs"});
  }
  /// "ok", or the message with the root left out.
  [[nodiscard]] std::string said(const SourcePolicy& policy, const std::string& file) const {
    const Status status = policy.check(file.starts_with("/") ? fs::path(file) : root() / file, "f");
    if (status) return "ok";
    std::string message = status.error().message;
    const std::size_t at = message.find(root().string() + "/");
    if (at != std::string::npos) message.erase(at, root().string().size() + 1);
    return message;
  }

 private:
  TemporaryFolder folder_;
};

constexpr const char* kOutside = ": must be a file inside of the server's data folders";

TEST_F(SourcePolicyTest, LetsRegularFilesInsideItsFoldersBeNamed) {
  for (const char* file : {"data/a.tif", "data/sub/b.tif", "data/inner"}) {
    EXPECT_EQ(said(policy(), file), "ok");
  }
  const auto missing = policy().check(root() / "data/none.tif", "f");
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(said(policy(), "data/none.tif"), "f = data/none.tif: no such file");
  EXPECT_EQ(said(policy(), "data/sub"), "f = data/sub: must be a regular file");
  EXPECT_EQ(said(policy(), "data/fifo"), "f = data/fifo: must be a regular file");
}

TEST_F(SourcePolicyTest, SaysTheSameOfEveryFileOutsideThereOrNot) {
  for (const std::string file : {"secret/s.tif",
                                 "secret/none.tif",
                                 "secret",
                                 "data2/x",
                                 "data",
                                 "data/outer",
                                 "data/dead",
                                 "data/folder/s.tif",
                                 "data/folder/none.tif",
                                 "data/folder/../data/a.tif",
                                 "data/../secret/s.tif",
                                 "data/../data/a.tif",
                                 "data/runs/one/scenario.json",
                                 "data/runs/none",
                                 "/etc/passwd",
                                 "/none",
                                 "/proc/self/mem",
                                 "/vsicurl/http://127.0.0.1/a.tif"}) {
    EXPECT_EQ(said(policy(), file), "f = " + file + kOutside);
    const std::string path = file.starts_with("/") ? file : (root() / file).string();
    EXPECT_EQ(policy().check(path, "f").error().code, ErrorCode::kInvalidArgument) << file;
  }
  const std::string cut =
      "/etc/passwd" + std::string(1, '\0') + "/../.." + root().string() + "/data/a.tif";
  EXPECT_FALSE(policy().check(cut, "f").ok());
}

TEST_F(SourcePolicyTest, KnowsAFolderByBothItsNames) {
  EXPECT_EQ(said(policy(), "other_name/a.tif"), "f = other_name/a.tif" + std::string(kOutside));
  const SourcePolicy by_link = SourcePolicy::inside({root() / "other_name"});
  EXPECT_EQ(said(by_link, "other_name/a.tif"), "ok");
  EXPECT_EQ(said(by_link, "data/a.tif"), "ok");
}

TEST_F(SourcePolicyTest, OfTheCommandLineTakesAnyRegularFile) {
  EXPECT_EQ(said({}, "secret/s.tif"), "ok");
  EXPECT_EQ(said({}, "data/../secret/s.tif"), "ok");
  EXPECT_EQ(said({}, "secret/none.tif"), "f = secret/none.tif: no such file");
  EXPECT_EQ(said({}, "data/fifo"), "f = data/fifo: must be a regular file");
  EXPECT_EQ(said({}, "/dev/zero"), "f = /dev/zero: must be a regular file");
  EXPECT_EQ(said({}, "/proc/self/mem"), "f = /proc/self/mem: must be a regular file");
  EXPECT_EQ(said({}, "/sys/kernel/uevent_seqnum"),
            "f = /sys/kernel/uevent_seqnum: must be a regular file");
}

TEST_F(SourcePolicyTest, CutsNamesOfAnyLength) {
  const auto status = policy().check(std::string(100'000, 'x'), "f");
  EXPECT_LT(status.error().message.size(), 500U);
}

}  // namespace
}  // namespace overfly
