// A study in its folder: what was asked, how it stands, what it has found.
//
// studies/NAME has study.json (this record), state.json (how it ended), progress.study.json (of the
// process that makes it), output.txt (what that process printed), input/ (scenario and hunt file),
// and the files of the command: explanation.json, predict.json and predict.html, or hunt.json and
// worst.json, with the run folders of its flights in runs/.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/studies/study_request.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

/// How a study stands. Those before kDone have not ended.
enum class StudyState { kWaiting, kRunning, kDone, kFailed, kCancelled, kInterrupted };
[[nodiscard]] const char* to_string(StudyState state);  ///< "waiting", "running", ...

/// What a study is made from; written once.
struct StudyRecord {
  StudyKind kind = StudyKind::kExplain;
  std::string title;    ///< for people
  std::string subject;  ///< id of the run, or name of the scenario
  std::string estimator;
  std::vector<std::string> options;  ///< of the command
  std::size_t jobs = 1;
  RunMemory memory;  ///< of one flight
  std::string created_utc;
};

/// How a study ended.
struct StudyEnd {
  StudyState state = StudyState::kInterrupted;
  std::string problem;  ///< why it failed or was interrupted
  std::string utc;
};

class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] std::filesystem::path scenario_file() const { return input() / "scenario.json"; }
  [[nodiscard]] std::filesystem::path hunt_file() const { return input() / "hunt.json"; }
  [[nodiscard]] std::filesystem::path progress_file() const {
    return folder_ / "progress.study.json";
  }
  [[nodiscard]] std::filesystem::path output_file() const { return folder_ / "output.txt"; }

  /// Whether it has a record.
  [[nodiscard]] bool exists() const;
  /// Errors: as write_json.
  [[nodiscard]] Status write(const StudyRecord& record) const;
  /// Errors: kNotFound; as read_json; kUnreadable naming the field.
  [[nodiscard]] Result<StudyRecord> read() const;
  [[nodiscard]] Status write_end(const StudyEnd& end) const;
  /// kInterrupted, with the reason, if it has not ended.
  [[nodiscard]] StudyEnd read_end() const;
  /// Forgets how it ended, and the progress of an earlier process.
  void begin_again() const;
  /// Writes one of the input files. Errors: kIo.
  [[nodiscard]] Status write_input(const std::filesystem::path& file,
                                   const nlohmann::json& document) const;
  /// {"share","text"} of the process that makes the study; null before it has written any.
  [[nodiscard]] nlohmann::json progress() const;
  /// The last error that the process printed; empty if there is none.
  [[nodiscard]] std::string printed_error() const;

 private:
  [[nodiscard]] std::filesystem::path input() const { return folder_ / "input"; }
  std::filesystem::path folder_;
};

}  // namespace overfly::server::experiments
