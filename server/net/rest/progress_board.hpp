// How far the slow work of requests is, by the clients' own names.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace overfly::net {

/// A step of some work and the share of it that is done.
struct WorkProgress {
  std::string step;
  double share = 0.0;  ///< [0, 1]
};

/// 8 to 64 letters, digits and '-': long enough that clients do not meet.
[[nodiscard]] bool is_progress_id(const std::string& id);

/// Thread-safe.
class ProgressBoard {
 public:
  static constexpr std::size_t kMaxEntries = 64;

  /// Work in progress: it is on the board until end(), or as long as it lives.
  class Entry {
   public:
    Entry(std::shared_ptr<ProgressBoard> board, std::string id)
        : board_(std::move(board)), id_(std::move(id)) {}
    ~Entry() { end(); }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

    void set(const std::string& step, double share) {
      const std::lock_guard lock(board_->mutex_);
      if (!ended_) board_->entries_[id_] = {step, share};
    }
    void end() {
      const std::lock_guard lock(board_->mutex_);
      if (!ended_) board_->entries_.erase(id_);
      ended_ = true;
    }

   private:
    std::shared_ptr<ProgressBoard> board_;
    std::string id_;
    bool ended_ = false;  ///< guarded by the board's mutex
  };

  /// Null if there are kMaxEntries, or one with this id.
  [[nodiscard]] static std::shared_ptr<Entry> begin(const std::shared_ptr<ProgressBoard>& board,
                                                    const std::string& id) {
    const std::lock_guard lock(board->mutex_);
    if (board->entries_.size() >= kMaxEntries || board->entries_.contains(id)) return nullptr;
    board->entries_[id] = {"waiting", 0.0};
    return std::make_shared<Entry>(board, id);
  }
  [[nodiscard]] std::optional<WorkProgress> find(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(id);
    return found == entries_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, WorkProgress> entries_;
};

}  // namespace overfly::net
