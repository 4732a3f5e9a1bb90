// Where the folders of runs are: in the folder of runs, or in those of sweeps and studies.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace overfly::server {

/// A run of a sweep or a study: its id is GROUP.RUN, and RUN has 20 hexadecimal digits.
struct GroupRunName {
  std::filesystem::path group;  ///< folder of the sweep or study
  std::string run;
};

class RunPlaces {
 public:
  /// @param group_folders  folders of sweeps and of studies; empty names are left out
  RunPlaces(std::filesystem::path runs_folder, std::vector<std::filesystem::path> group_folders);

  /// The folder of a run, which may be absent. A run in the folder of runs precedes one of a group
  /// with the same id. @pre is_plain_name(id)
  [[nodiscard]] std::filesystem::path of(const std::string& id) const;
  /// Empty if a run is none of a group. Of several groups with the name, the first with the run.
  /// @pre is_plain_name(id)
  [[nodiscard]] std::optional<GroupRunName> in_group(const std::string& id) const;

 private:
  std::filesystem::path runs_folder_;
  std::vector<std::filesystem::path> group_folders_;
};

}  // namespace overfly::server
