#include "server/experiments/sweep_progress.hpp"

#include <cstdint>
#include <string_view>

#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kMaxBytes = 4096;

fs::path progress_file(const fs::path& folder) { return folder / "progress.json"; }

}  // namespace

Status write_progress(const fs::path& folder, const SweepProgress& progress) {
  return write_json(progress_file(folder),
                    {{"passed", progress.passed},
                     {"most", progress.most},
                     {"flown", progress.flown},
                     {"failed", progress.failed},
                     {"left_s", progress.left_s ? Json(*progress.left_s) : Json(nullptr)},
                     {"spent_s", progress.spent_s}});
}

Json read_progress(const fs::path& folder) {
  const Result<Json> read = read_json(progress_file(folder), kMaxBytes);
  if (!read || !read->is_object()) return nullptr;
  Json progress = Json::object();
  for (const char* name : {"passed", "most", "flown", "failed", "left_s", "spent_s"}) {
    const auto found = read->find(name);
    if (found == read->end()) return nullptr;
    const bool unknown = std::string_view(name) == "left_s" && found->is_null();
    if (!unknown && !found->is_number()) return nullptr;
    progress[name] = *found;
  }
  return progress;
}

}  // namespace overfly::server::experiments
