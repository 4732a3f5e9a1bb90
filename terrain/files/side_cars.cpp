#include "terrain/files/side_cars.hpp"

#include <algorithm>
#include <cctype>

#include "core/text/lower_case.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// GDAL looks for extensions in upper and in lower case.
std::multimap<std::string, std::string> names_in(const fs::path& folder) {
  std::multimap<std::string, std::string> names;
  std::error_code failed;
  // GDAL could not list such a folder either.
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::string name = entry->path().filename().string();
    names.emplace(lower_case(name), std::move(name));
  }
  return names;
}

}  // namespace

std::vector<fs::path> SideCars::of(const fs::path& file) {
  std::error_code ignored;
  const fs::path place = fs::absolute(file, ignored).lexically_normal();
  const fs::path folder = place.parent_path();
  const auto [known, added] = folders_.try_emplace(folder);
  if (added) known->second = names_in(folder);
  const std::string own = place.filename().string();
  const std::string begin = lower_case(place.stem().string()) + ".";
  std::vector<fs::path> side_cars;
  for (auto name = known->second.lower_bound(begin);
       name != known->second.end() && name->first.starts_with(begin);
       ++name) {
    if (name->second != own) side_cars.push_back(folder / name->second);
  }
  return side_cars;
}

Status SideCars::check(const fs::path& file,
                       const std::string& field,
                       const SourcePolicy& sources) {
  for (const fs::path& side_car : of(file)) {
    Status status = sources.check_place(side_car, field + " (a file next to it)");
    if (!status) return status;
  }
  return {};
}

std::vector<std::string> SideCars::doubts(const fs::path& file) {
  std::vector<std::string> doubts;
  for (const fs::path& side_car : of(file)) {
    std::error_code failed;
    const fs::file_status found = fs::status(side_car, failed);
    if (!fs::is_other(found)) continue;
    doubts.push_back(side_car.string() + ": is not a regular file and is ignored, although " +
                     file.filename().string() + " is next to it");
  }
  return doubts;
}

}  // namespace overfly::terrain
