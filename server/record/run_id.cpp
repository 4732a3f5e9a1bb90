#include "server/record/run_id.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <string_view>

#include "server/record/run_folder.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Six of 32 letters and digits that are not easily confused.
std::string random_part() {
  constexpr std::string_view kLetters = "abcdefghijkmnpqrstuvwxyz23456789";
  static_assert(kLetters.size() == 32);
  std::random_device device;
  std::uint32_t bits = device();
  std::string text;
  for (int i = 0; i < 6; ++i, bits >>= 5U) text += kLetters[bits & 31U];
  return text;
}

/// 2026-11-21T09:12:04.123456Z -> 20261121-091204
std::string stamp_of(std::int64_t now_ns) {
  std::string stamp = utc_text(now_ns).substr(0, 19);
  std::erase_if(stamp, [](char c) { return c == '-' || c == ':'; });
  std::replace(stamp.begin(), stamp.end(), 'T', '-');
  return stamp;
}

}  // namespace

Result<std::string> reserve_run(const fs::path& runs_folder,
                                const std::string& scenario,
                                std::int64_t now_ns) {
  constexpr int kAttempts = 100;
  for (int i = 0; i < kAttempts; ++i) {
    std::string id = stamp_of(now_ns) + "-" + scenario + "-" + random_part();
    const fs::path folder = runs_folder / id;
    if (::mkdir(folder.c_str(), 0777) == 0) return id;
    if (errno != EEXIST) {
      return Error{ErrorCode::kIo, folder.string() + ": cannot create: " + std::strerror(errno)};
    }
  }
  return Error{ErrorCode::kIo, runs_folder.string() + ": no unused run id found"};
}

bool is_run_id(const std::string& name) {
  constexpr std::string_view kForm = "00000000-000000-";
  if (name.size() <= kForm.size()) return false;
  return std::equal(kForm.begin(), kForm.end(), name.begin(), [](char form, char c) {
    return form == '-' ? c == '-' : c >= '0' && c <= '9';
  });
}

void release_run(const fs::path& runs_folder, const std::string& id) {
  ::rmdir((runs_folder / id).c_str());
}

}  // namespace overfly::server
