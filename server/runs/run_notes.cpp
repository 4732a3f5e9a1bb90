#include "server/runs/run_notes.hpp"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Larger than any file that write_notes writes.
constexpr std::uint64_t kMaxFileBytes = 64U << 10U;

Error invalid(const std::string& field, const std::string& must) {
  return {ErrorCode::kInvalidArgument, field + ": must " + must};
}

bool has_control(const std::string& text, const std::string& allowed) {
  return std::any_of(text.begin(), text.end(), [&](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 || byte == 0x7f) && allowed.find(c) == std::string::npos;
  });
}

}  // namespace

Status check_notes(const RunNotes& notes) {
  if (notes.tags.size() > kMaxTags) {
    return invalid("tags", "have at most " + std::to_string(kMaxTags) + " elements");
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < notes.tags.size(); ++i) {
    const std::string& tag = notes.tags[i];
    const std::string field = "tags." + std::to_string(i);
    if (tag.empty() || tag.size() > kMaxTagBytes) {
      return invalid(field, "have 1 to " + std::to_string(kMaxTagBytes) + " bytes");
    }
    if (tag.front() == ' ' || tag.back() == ' ' || tag.find(',') != std::string::npos ||
        has_control(tag, "")) {
      return invalid(field, "have no comma, no control characters and no blank at its ends");
    }
    if (!seen.insert(tag).second) return invalid(field, "differ from the other tags");
  }
  if (notes.note.size() > kMaxNoteBytes) {
    return invalid("note", "have at most " + std::to_string(kMaxNoteBytes) + " bytes");
  }
  if (has_control(notes.note, "\t\n")) {
    return invalid("note", "have no control characters other than tab and line feed");
  }
  return {};
}

fs::path notes_file(const fs::path& run_folder) { return run_folder / "notes.json"; }

Result<RunNotes> read_notes(const fs::path& run_folder) {
  const fs::path file = notes_file(run_folder);
  const Result<nlohmann::json> document = read_json(file, kMaxFileBytes);
  if (!document) {
    if (document.error().code == ErrorCode::kNotFound) return RunNotes{};
    return document.error();
  }
  Result<RunNotes> notes = guarded_fields([&] {
    const FileField fields(*document);
    RunNotes read;
    for (const FileField& tag : fields.at("tags").items()) read.tags.push_back(tag.text());
    read.note = fields.at("note").text();
    return read;
  });
  Status status = notes ? check_notes(*notes) : Status(notes.error());
  if (!status) {
    return Error{ErrorCode::kUnreadable, file.string() + ": " + status.error().message};
  }
  return notes;
}

Status write_notes(const fs::path& run_folder, const RunNotes& notes) {
  if (Status status = check_notes(notes); !status) return status;
  const fs::path file = notes_file(run_folder);
  if (notes != RunNotes{}) return write_json(file, {{"tags", notes.tags}, {"note", notes.note}});
  std::error_code failure;
  fs::remove(file, failure);
  if (failure) return Error{ErrorCode::kIo, file.string() + ": " + failure.message()};
  return {};
}

}  // namespace overfly::server
