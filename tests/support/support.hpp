// What the tests of several rooms share.
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

namespace overfly::testing {

/// A new empty folder, removed with all it holds when the object goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A file of the shared recordings (`terrain/autzen/...`): $OVERFLY_DATA, else ../shared/data
/// next to the source tree. Empty if it is missing: the test is then skipped with that reason.
[[nodiscard]] std::optional<std::filesystem::path> shared_data(const std::string& relative);

/// Path below the source tree.
[[nodiscard]] std::filesystem::path source_file(const std::string& relative);

/// The larger of two errors, or NaN if one of them is NaN, which std::max(worst, error) passes
/// over.
[[nodiscard]] inline double larger_error(double worst, double error) {
  return std::isnan(worst) || worst >= error ? worst : error;
}

void write_text(const std::filesystem::path& file, const std::string& text);
[[nodiscard]] std::string read_text(const std::filesystem::path& file);

}  // namespace overfly::testing

/// Declares `name` as a path, or skips the test with the reason.
#define OVERFLY_DATA_OR_SKIP(name, relative)                                              \
  const auto name##_or_none = ::overfly::testing::shared_data(relative);                  \
  if (!name##_or_none) GTEST_SKIP() << "shared data file " << (relative) << " is absent"; \
  const std::filesystem::path& name = *name##_or_none
