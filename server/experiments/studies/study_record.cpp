#include "server/experiments/studies/study_record.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "core/outside/file_text.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kMaxRecordBytes = std::uint64_t{1} << 20U;
constexpr std::uint64_t kMaxOutputBytes = std::uint64_t{64} << 20U;
constexpr std::size_t kLongestProblem = 1000;
/// Limit of --jobs.
constexpr std::size_t kMostJobs = 256;

constexpr std::array<const char*, 3> kKinds = {"explain", "predict", "hunt"};
constexpr std::array<const char*, 6> kStates = {
    "waiting", "running", "done", "failed", "cancelled", "interrupted"};

template <std::size_t N>
std::optional<std::size_t> place_of(const std::array<const char*, N>& names,
                                    const std::string& text) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::string text_field(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::uint64_t number_field(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

}  // namespace

const char* to_string(StudyKind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }

std::optional<StudyKind> study_kind_from(const std::string& text) {
  const auto place = place_of(kKinds, text);
  if (!place) return std::nullopt;
  return static_cast<StudyKind>(*place);
}

const char* to_string(StudyState state) { return kStates.at(static_cast<std::size_t>(state)); }

bool StudyFolder::exists() const { return FileStamp::of(folder_ / "study.json").exists; }

Status StudyFolder::write(const StudyRecord& record) const {
  return write_json(folder_ / "study.json",
                    {{"format_version", 1},
                     {"kind", to_string(record.kind)},
                     {"title", record.title},
                     {"subject", record.subject},
                     {"estimator", record.estimator},
                     {"options", record.options},
                     {"jobs", record.jobs},
                     {"images_bytes", record.memory.images_bytes},
                     {"caches_bytes", record.memory.caches_bytes},
                     {"created_utc", record.created_utc}});
}

Result<StudyRecord> StudyFolder::read() const {
  const fs::path file = folder_ / "study.json";
  if (!exists()) {
    return Error{ErrorCode::kNotFound,
                 "study \"" + folder_.filename().string() + "\": no such study"};
  }
  const Result<Json> document = read_json(file, kMaxRecordBytes);
  if (!document) return document.error();
  const auto kind = study_kind_from(document->is_object() ? text_field(*document, "kind") : "");
  if (!kind) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": kind: must be explain, predict or hunt"};
  }
  StudyRecord record;
  record.kind = *kind;
  record.title = text_field(*document, "title");
  record.subject = text_field(*document, "subject");
  record.estimator = text_field(*document, "estimator");
  const auto options = document->find("options");
  if (options == document->end() || !options->is_array()) {
    return Error{ErrorCode::kUnreadable, file.string() + ": options: must be a list of texts"};
  }
  for (const Json& option : *options) {
    if (option.is_string()) record.options.push_back(option.get<std::string>());
  }
  record.jobs = std::clamp<std::size_t>(number_field(*document, "jobs"), 1, kMostJobs);
  record.memory.images_bytes = number_field(*document, "images_bytes");
  record.memory.caches_bytes = number_field(*document, "caches_bytes");
  record.created_utc = text_field(*document, "created_utc");
  return record;
}

Status StudyFolder::write_end(const StudyEnd& end) const {
  return write_json(folder_ / "state.json",
                    {{"state", to_string(end.state)}, {"problem", end.problem}, {"utc", end.utc}});
}

StudyEnd StudyFolder::read_end() const {
  const StudyEnd broken{StudyState::kInterrupted, "the server ended before the study did", ""};
  const Result<Json> document = read_json(folder_ / "state.json", kMaxRecordBytes);
  if (!document || !document->is_object()) return broken;
  const auto state = place_of(kStates, text_field(*document, "state"));
  if (!state || static_cast<StudyState>(*state) < StudyState::kDone) return broken;
  return {static_cast<StudyState>(*state),
          text_field(*document, "problem"),
          text_field(*document, "utc")};
}

void StudyFolder::begin_again() const {
  std::error_code ignored;
  fs::remove(folder_ / "state.json", ignored);
  fs::remove(progress_file(), ignored);
}

Status StudyFolder::write_input(const fs::path& file, const Json& document) const {
  std::error_code failed;
  fs::create_directories(file.parent_path(), failed);
  if (failed) return Error{ErrorCode::kIo, file.parent_path().string() + ": " + failed.message()};
  return write_json(file, document);
}

Json StudyFolder::progress() const {
  const Result<Json> document = read_json(progress_file(), kMaxRecordBytes);
  if (!document || !document->is_object()) return nullptr;
  const auto share = document->find("share");
  if (share == document->end() || !share->is_number()) return nullptr;
  return {{"share", std::clamp(share->get<double>(), 0.0, 1.0)},
          {"text", text_field(*document, "text")}};
}

std::string StudyFolder::printed_error() const {
  const Result<std::string> text = read_file_text(output_file(), kMaxOutputBytes);
  if (!text) return "";
  constexpr std::string_view kMark = "error: ";
  const std::size_t last = text->rfind("\n" + std::string(kMark));
  std::size_t begin = 0;
  if (last != std::string::npos) {
    begin = last + 1;
  } else if (!text->starts_with(kMark)) {
    return "";
  }
  std::string error = text->substr(begin + kMark.size(), kLongestProblem);
  while (!error.empty() && error.back() == '\n') error.pop_back();
  return error;
}

}  // namespace overfly::server::experiments
