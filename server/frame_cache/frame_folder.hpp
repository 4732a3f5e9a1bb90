// The folder of a frame cache: one file for each picture, within a budget.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"

namespace overfly::server {

struct FrameFolderOptions {
  std::filesystem::path folder;
  std::uint64_t budget_bytes = 0;  ///< of all pictures together; 0: none is added
  /// Pictures that were used since then are never removed [Unix time]. Without this limit a series
  /// of flights that needs more than the budget would remove each picture before its next use.
  std::int64_t keep_since_ns = 0;
  /// Room on the disk that must be left, so that flights can write their results.
  std::uint64_t least_free_bytes = std::uint64_t{1} << 30U;
};

/// May be used by any number of processes of one machine at the same time; pictures are added by
/// one thread of each. A file is written under another name and renamed, so that none is seen in
/// parts; processes that are killed leave at most files that later ones remove.
///
/// The budget includes files that are being written: a process enters the size of a file in the
/// ledger before it writes it. When the budget is spent, the pictures that were used longest ago
/// are removed.
class FrameFolder {
 public:
  explicit FrameFolder(FrameFolderOptions options) : options_(std::move(options)) {}

  /// Creates the folder. Errors: kIo.
  [[nodiscard]] Status create() const;
  /// The bytes of a picture, which counts as used now; empty if there is none.
  /// @param max_bytes  of the file; a larger one is damaged
  /// Errors: kUnreadable for a file that is too large; kIo.
  [[nodiscard]] Result<std::optional<std::vector<std::uint8_t>>> read(const std::string& key,
                                                                      std::size_t max_bytes) const;

  enum class Added {
    kAdded,
    kKnown,   ///< it was there
    kNoRoom,  ///< all pictures have been used since keep_since_ns
    kBusy,    ///< another process held the ledger too long
  };
  [[nodiscard]] bool is_known(const std::string& key) const;
  /// Errors: kIo with the system's reason, as for a full disk.
  [[nodiscard]] Result<Added> add(const std::string& key, std::span<const std::uint8_t> bytes);
  void remove(const std::string& key) const;
  [[nodiscard]] std::filesystem::path file_of(const std::string& key) const;

 private:
  /// Enters a file of this size in the ledger and creates it.
  Result<Added> reserve(std::uint64_t size,
                        const std::filesystem::path& part,
                        FileDescriptor& file);
  [[nodiscard]] Status check_disk(std::uint64_t size) const;

  FrameFolderOptions options_;
  /// No search for room before then, as the last one found none.
  std::chrono::steady_clock::time_point search_again_{};
};

}  // namespace overfly::server
