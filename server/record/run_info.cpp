#include "server/record/run_info.hpp"

namespace overfly::server {

const char* to_string(RunStatus status) {
  switch (status) {
    case RunStatus::kQueued:
      return "queued";
    case RunStatus::kRunning:
      return "running";
    case RunStatus::kCompleted:
      return "completed";
    case RunStatus::kFailed:
      return "failed";
    case RunStatus::kCancelled:
      return "cancelled";
    case RunStatus::kInterrupted:
      return "interrupted";
    case RunStatus::kUnreadable:
      return "unreadable";
  }
  return "failed";
}

}  // namespace overfly::server
