// The files in a server's data folders that clients may read, by name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"

namespace overfly::server {

/// Where files lie that clients may read.
struct ServedFolders {
  std::filesystem::path uploads;               ///< empty = there are no uploads
  std::vector<std::filesystem::path> folders;  ///< data folders
  SourcePolicy sources;                        ///< which files may be read
};

/// A file that clients may read.
struct DataFile {
  std::string name;  ///< a label of its folder, "/", and its path in it: "data/sitl/plane25.BIN"
  std::filesystem::path path;
  bool uploaded = false;
};

/// Label of the folder of uploads in names.
inline constexpr const char* kUploadsLabel = "uploads";
/// Limits of a list: entries of folders that are looked at, and depth of folders.
inline constexpr std::size_t kMaxVisitedFiles = 20'000;
inline constexpr int kMaxDataDepth = 6;

/// Passes the regular files of the folders to `take`, until that returns false. Hidden files and
/// folders, links to folders, and names that JSON cannot repeat are left out.
/// @param candidate  whether a file with this name is wanted
/// @return false if there are more than kMaxVisitedFiles entries, or if `take` returned false
bool visit_data_files(const ServedFolders& folders,
                      const std::function<bool(const std::string& name)>& candidate,
                      const std::function<bool(const DataFile&)>& take);

/// Passes the files of one folder, but not of those in it, to `take`, until that returns false.
/// What is left out is as above, without the limit of entries.
/// @param name  of the folder, as in the names of its files: "data/photos". There are no files for
/// every name that is not the one of a folder inside the folders
void visit_data_folder(const ServedFolders& folders,
                       const std::string& name,
                       const std::function<bool(const std::string& name)>& candidate,
                       const std::function<bool(const DataFile&)>& take);

/// The file of a name. Empty for every name that is not the one of a regular file inside the
/// folders, whether the file exists or not.
[[nodiscard]] std::optional<std::filesystem::path> find_data_file(
    const ServedFolders& folders,
    const std::string& name,
    const std::function<bool(const std::string& name)>& candidate);

}  // namespace overfly::server
