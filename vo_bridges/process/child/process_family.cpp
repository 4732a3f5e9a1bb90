#include "vo_bridges/process/child/process_family.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <system_error>
#include <thread>

#include "vo_bridges/proc_files.hpp"

namespace overfly::process {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMemberLimit = 65536;
constexpr std::size_t kEnvironmentLimitBytes = 4'000'000;

struct ProcessStat {
  char state = 'X';
  int group = 0;
  int session = 0;

  [[nodiscard]] bool zombie() const { return state == 'Z' || state == 'X'; }
};

/// Fields 3, 5 and 6 of stat (proc(5)); empty if there is no such process.
std::optional<ProcessStat> stat_of(int pid) {
  std::optional<std::istringstream> fields = stat_after_name(pid);
  if (!fields) return std::nullopt;
  ProcessStat stat;
  int parent = 0;
  if (!(*fields >> stat.state >> parent >> stat.group >> stat.session)) return std::nullopt;
  return stat;
}

bool has_in_environment(int pid, const std::string& entry) {
  std::ifstream file(proc_folder(pid) / "environ", std::ios::binary);
  std::size_t read = 0;
  for (std::string text; std::getline(file, text, '\0') && read < kEnvironmentLimitBytes;) {
    if (text == entry) return true;
    read += text.size() + 1;
  }
  return false;
}

std::string fresh_mark() {
  std::random_device random;
  std::ostringstream text;
  text << "OVERFLY_FAMILY=" << ::getpid() << "-" << std::hex << random() << random() << random();
  return text.str();
}

}  // namespace

ProcessFamily::ProcessFamily() : mark_(fresh_mark()) { ::prctl(PR_SET_CHILD_SUBREAPER, 1); }

std::vector<int> ProcessFamily::living_members(int child) const {
  std::vector<int> found = children_of(child);
  for (const int ours : children_of(::getpid())) {
    if (ours != child && has_in_environment(ours, mark_)) found.push_back(ours);
  }
  for (std::size_t i = 0; i < found.size() && found.size() < kMemberLimit; ++i) {
    const std::vector<int> next = children_of(found[i]);
    found.insert(found.end(), next.begin(), next.end());
  }
  std::erase_if(found, [](int pid) {
    const std::optional<ProcessStat> stat = stat_of(pid);
    return !stat || stat->zombie();
  });
  return found;
}

void ProcessFamily::kill_members(int child) {
  for (const int pid : living_members(child)) {
    ::kill(pid, SIGKILL);
    killed_.insert(pid);
  }
}

void ProcessFamily::end(int child, std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kStep(2);
  const auto deadline = Clock::now() + patience;
  while (!living_members(child).empty() && Clock::now() < deadline) {
    kill_members(child);
    std::this_thread::sleep_for(kStep);
  }
  // The list of children may omit one while another ends (proc(5)), so each killed process is
  // waited for by its id. Processes that did not become children of this process give ECHILD.
  for (const int pid : killed_) {
    while (::waitpid(pid, nullptr, WNOHANG) == 0 && Clock::now() < deadline) {
      std::this_thread::sleep_for(kStep);
    }
  }
  reap(child);
}

/// Reaps processes that ended by themselves after they became children of this process: in the
/// child's group or in their own session.
void ProcessFamily::reap(int child) const {
  const int own_session = ::getsid(0);
  for (const int ours : children_of(::getpid())) {
    if (ours == child) continue;
    const std::optional<ProcessStat> stat = stat_of(ours);
    if (!stat || !stat->zombie()) continue;
    if (stat->group != child && stat->session == own_session) continue;
    ::waitpid(ours, nullptr, WNOHANG);
  }
}

}  // namespace overfly::process
