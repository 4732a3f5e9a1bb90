// What people write about a run: tags and a note, in its folder (notes.json).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server {

struct RunNotes {
  std::vector<std::string> tags;  ///< distinct, in the order in which they were given
  std::string note;               ///< may have several lines
  bool operator==(const RunNotes&) const = default;
};

inline constexpr std::size_t kMaxTags = 16;
inline constexpr std::size_t kMaxTagBytes = 40;
inline constexpr std::size_t kMaxNoteBytes = 4000;

/// Errors: kInvalidArgument naming field, value and limit: too many or equal tags; a tag that is
/// empty, too long, begins or ends with a blank, or has a comma or control characters; a note that
/// is too long or has control characters other than tab and line feed.
[[nodiscard]] Status check_notes(const RunNotes& notes);

[[nodiscard]] std::filesystem::path notes_file(const std::filesystem::path& run_folder);
/// Empty notes if there is no file. Errors: as read_json; kUnreadable naming file and field.
[[nodiscard]] Result<RunNotes> read_notes(const std::filesystem::path& run_folder);
/// Empty notes delete the file. Errors: as check_notes; kIo.
[[nodiscard]] Status write_notes(const std::filesystem::path& run_folder, const RunNotes& notes);

}  // namespace overfly::server
