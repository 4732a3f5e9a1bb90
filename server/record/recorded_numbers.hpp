// Numbers of the files that an estimator's recording consists of: NNNNNN.* in a folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <vector>

namespace overfly::server {

/// Remembers the folders that were listed lately, so that a long recording is not listed for every
/// picture. Used on one thread.
class RecordedNumbers {
 public:
  /// The number of the last file at or before `frame`; empty if there is none.
  [[nodiscard]] std::optional<std::int64_t> last(const std::filesystem::path& folder,
                                                 std::int64_t frame);

 private:
  struct Listed {
    std::filesystem::path folder;
    std::filesystem::file_time_type changed;  ///< of the folder, when it was listed
    std::vector<std::int64_t> numbers;        ///< ascending
  };
  const Listed& listed(const std::filesystem::path& folder);

  std::list<Listed> known_;  ///< most recently used first
};

}  // namespace overfly::server
