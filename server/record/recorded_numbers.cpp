#include "server/record/recorded_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Debug images and map points of the estimators of a viewer's runs.
constexpr std::size_t kMostFolders = 64;
/// A folder that changed so recently may change again within the same tick of the file system's
/// clock: it is listed again.
constexpr std::chrono::seconds kSettled{2};

std::vector<std::int64_t> numbers_in(const fs::path& folder) {
  std::vector<std::int64_t> numbers;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().stem().string();
    std::int64_t number = 0;
    const char* name_end = name.data() + name.size();
    const auto [rest, failure] = std::from_chars(name.data(), name_end, number);
    if (failure == std::errc() && rest == name_end) numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace

const RecordedNumbers::Listed& RecordedNumbers::listed(const fs::path& folder) {
  std::error_code error;
  const fs::file_time_type changed = fs::last_write_time(folder, error);
  const auto known = std::find_if(
      known_.begin(), known_.end(), [&](const Listed& other) { return other.folder == folder; });
  if (known != known_.end()) {
    known_.splice(known_.begin(), known_, known);
  } else {
    known_.push_front({folder, fs::file_time_type::min(), {}});
    if (known_.size() > kMostFolders) known_.pop_back();
  }
  Listed& listed = known_.front();
  const bool settled = fs::file_time_type::clock::now() - changed > kSettled;
  if (error || listed.changed != changed || !settled) {
    listed.numbers = numbers_in(folder);
    listed.changed = changed;
  }
  return listed;
}

std::optional<std::int64_t> RecordedNumbers::last(const fs::path& folder, std::int64_t frame) {
  const std::vector<std::int64_t>& numbers = listed(folder).numbers;
  const auto after = std::upper_bound(numbers.begin(), numbers.end(), frame);
  if (after == numbers.begin()) return std::nullopt;
  return *std::prev(after);
}

}  // namespace overfly::server
