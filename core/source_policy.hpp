// Which files of this machine a scenario, an override or a world manifest may name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly {

/// The one check of every file that is named from outside, before anything opens it.
///
/// On the command line any regular file may be named: the user may read it anyhow. A server lets
/// its clients name files inside its data folders only, and says the same about all others, so
/// that nobody learns what exists on the machine.
class SourcePolicy {
 public:
  /// Any regular file: of the command line.
  SourcePolicy() = default;
  /// Only regular files inside of these folders, and not inside of `excluded`. Both are taken as
  /// given and with their links resolved; a folder that does not exist holds nothing.
  static SourcePolicy inside(std::vector<std::filesystem::path> folders,
                             std::vector<std::filesystem::path> excluded = {});

  /// The same policy narrowed to one folder, for files that a file names: a policy of any file
  /// stays one.
  [[nodiscard]] SourcePolicy narrowed_to(const std::filesystem::path& folder) const;
  /// False for a policy of any file.
  [[nodiscard]] bool confined() const { return confined_; }

  /// Whether a file may be named: it lies in a data folder as named and with all links resolved,
  /// is a regular file, and belongs to no file system of the kernel's own (/proc, /sys).
  /// @param file   confined policies refuse `..` in it: make it lexically normal before
  /// @param field  that names it, as "world.imagery.0.file"
  /// Errors: kInvalidArgument "FIELD = FILE: must ...", word for word the same for every file
  /// outside of the data folders, there or not; kNotFound inside of them.
  [[nodiscard]] Status check(const std::filesystem::path& file, const std::string& field) const;
  /// The same for a file of any kind, also for none: whether it lies in a data folder.
  [[nodiscard]] Status check_place(const std::filesystem::path& file,
                                   const std::string& field) const;

 private:
  [[nodiscard]] bool holds(const std::filesystem::path& plain) const;

  bool confined_ = false;
  std::vector<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> excluded_;
};

}  // namespace overfly
