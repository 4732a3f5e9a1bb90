// results.jsonl of a sweep's folder: one line for each flight of an estimator that is over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server::experiments {

struct SweepResult {
  std::string key;         ///< as result_key
  nlohmann::json cell;     ///< SweepCell::values
  int repeat = 0;          ///< from 0
  std::uint64_t seed = 0;  ///< of the scenario
  std::string estimator;
  std::string run;    ///< its run folder, relative to the sweep's
  std::string error;  ///< why the flight failed; empty if it was completed
  /// This line takes back the result of its cell, repeat and estimator.
  bool withdrawn = false;
  /// Of a completed flight. A flight that failed says nothing about the estimator.
  evaluation::Outcome outcome = evaluation::Outcome::kNotInitialised;
  double duration_s = 0.0;  ///< of the flight, by the clock on the wall
  std::size_t line = 0;     ///< of results.jsonl, from 0: a later line is newer

  [[nodiscard]] bool completed() const { return error.empty(); }
};

/// Later lines replace earlier ones with the same key.
class SweepResults {
 public:
  /// Reads the file if there is one. Lines that are no results are counted; a last line without
  /// line feed, which a kill leaves or which is being written, is ignored. Errors: as
  /// read_file_text.
  [[nodiscard]] static Result<SweepResults> read(const std::filesystem::path& folder);
  /// As read(), to add results: a last line that was cut off is removed from the file.
  /// @pre no other process adds results
  /// Errors: as read(); kIo.
  [[nodiscard]] static Result<SweepResults> open(const std::filesystem::path& folder);

  /// The newest with this key, whatever its cell and repeat. Null if there is none.
  [[nodiscard]] const SweepResult* find(const std::string& key) const;
  /// Whether the newest result of this flight (cell, repeat, estimator) has its key and error.
  [[nodiscard]] bool has(const SweepResult& result) const;
  /// Errors: kIo.
  Status add(const SweepResult& result);
  /// Takes a result from newest() and has(); find() still knows it. Errors: kIo.
  Status withdraw(SweepResult result);
  [[nodiscard]] const std::map<std::string, SweepResult>& by_key() const { return by_key_; }
  /// The newest result of each flight (cell, repeat, estimator). It may be of another version of
  /// the program or of the estimator, or of another seed, until it is flown again or withdrawn. In
  /// the order of the lines. Cells have plain numbers (with_plain_numbers).
  [[nodiscard]] std::vector<const SweepResult*> newest() const;
  /// Number of lines that are no results.
  [[nodiscard]] int unreadable_lines() const { return unreadable_lines_; }

 private:
  void keep(SweepResult result);

  std::filesystem::path file_;
  std::map<std::string, SweepResult> by_key_;
  std::map<std::string, SweepResult> by_flight_;  ///< cell, repeat, estimator -> newest
  int unreadable_lines_ = 0;
  std::size_t lines_ = 0;
  std::size_t whole_lines_bytes_ = 0;  ///< size of the file without a last line that was cut off
};

}  // namespace overfly::server::experiments
