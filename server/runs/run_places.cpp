#include "server/runs/run_places.hpp"

#include <algorithm>
#include <system_error>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 20;

fs::path run_in(const fs::path& group, const std::string& run) { return group / "runs" / run; }

}  // namespace

RunPlaces::RunPlaces(fs::path runs_folder, std::vector<fs::path> group_folders)
    : runs_folder_(std::move(runs_folder)), group_folders_(std::move(group_folders)) {
  std::erase_if(group_folders_, [](const fs::path& folder) { return folder.empty(); });
}

std::optional<GroupRunName> RunPlaces::in_group(const std::string& id) const {
  if (group_folders_.empty() || id.size() < kDigits + 2) return std::nullopt;
  const std::size_t dot = id.size() - kDigits - 1;
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  const auto digits = id.begin() + static_cast<std::ptrdiff_t>(dot) + 1;
  if (id[dot] != '.' || !std::all_of(digits, id.end(), is_digit)) return std::nullopt;
  std::error_code ignored;
  if (fs::exists(runs_folder_ / id, ignored)) return std::nullopt;
  const std::string group = id.substr(0, dot);
  const std::string run = id.substr(dot + 1);
  for (const fs::path& folder : group_folders_) {
    if (fs::exists(run_in(folder / group, run), ignored)) return GroupRunName{folder / group, run};
  }
  return GroupRunName{group_folders_.front() / group, run};
}

fs::path RunPlaces::of(const std::string& id) const {
  const auto name = in_group(id);
  return name ? run_in(name->group, name->run) : runs_folder_ / id;
}

}  // namespace overfly::server
