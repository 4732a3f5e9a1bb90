// Where the rows of a run's sensor files are by time, so that a stretch is read without the rest.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/files/file_stamp.hpp"
#include "server/record/rows/sensor_row_reader.hpp"

namespace overfly::server {

/// Consecutive rows of a file.
struct SensorBlock {
  RowPlace begin;
  std::uint64_t end = 0;      ///< offset behind the last row
  std::int64_t first_ns = 0;  ///< smallest and largest time of measurement
  std::int64_t last_ns = 0;
};

/// Index of one file, from its first row to end(). Files only grow: more rows extend it.
class SensorFileIndex {
 public:
  /// Blocks have 64 KiB. When there are too many, each two become one, and later ones are larger:
  /// an hour of 200 Hz has about 1100.
  static constexpr std::size_t kMaxBlocks = 2048;

  /// @param first_row  the place behind the header
  void start(const RowPlace& first_row);
  [[nodiscard]] bool started() const { return end_.lines > 0; }
  /// Adds the row between end() and `next`.
  void add(std::int64_t t_ns, const RowPlace& next);
  [[nodiscard]] const RowPlace& end() const { return end_; }
  [[nodiscard]] bool empty() const { return blocks_.empty(); }
  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  /// Blocks with times in [from_ns, to_ns]; those that lie one behind the other as one.
  [[nodiscard]] std::vector<SensorBlock> stretches(std::int64_t from_ns, std::int64_t to_ns) const;

  /// Of the file when it was last read.
  FileStamp stamp;

 private:
  void merge_pairs();

  std::vector<SensorBlock> blocks_;
  std::uint64_t block_bytes_ = std::uint64_t{64} << 10U;
  RowPlace end_;
};

/// Indexes of the files of one run. Thread-safe.
class SensorIndex {
 public:
  static constexpr std::size_t kFiles = 6;  ///< one for each kind of sensor

  /// A copy to read with; empty if the file was changed otherwise than by appending.
  [[nodiscard]] SensorFileIndex of(std::size_t file, const FileStamp& stamp) const;
  /// Keeps an index if it reaches further than the present one, or is of another file.
  void keep(std::size_t file, SensorFileIndex index);

 private:
  mutable std::mutex mutex_;
  std::array<SensorFileIndex, kFiles> files_;
};

/// The indexes of the runs that were read last. Thread-safe.
class SensorIndexShelf {
 public:
  /// At most 600 KB each.
  static constexpr std::size_t kMaxRuns = 16;

  [[nodiscard]] std::shared_ptr<SensorIndex> of(const std::filesystem::path& run_folder);

 private:
  std::mutex mutex_;
  std::list<std::pair<std::string, std::shared_ptr<SensorIndex>>> runs_;  ///< latest first
};

}  // namespace overfly::server
