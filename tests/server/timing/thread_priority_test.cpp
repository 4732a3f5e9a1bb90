#include "server/timing/thread_priority.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <thread>

namespace overfly::server {
namespace {

int nice_of_this_thread() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

std::string session_line() {
  std::string line;
  std::ifstream file("/proc/self/autogroup");
  std::getline(file, line);
  return line;
}

/// Whether this process may raise a thread at all.
bool may_raise() {
  bool raised = false;
  std::thread([&raised] {
    raised = setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), -1) == 0;
  }).join();
  return raised;
}

TEST(ThreadPriority, RaisesTheThreadAndWhatItStartsUntilItEnds) {
  if (!may_raise()) GTEST_SKIP() << "needs root or CAP_SYS_NICE";
  const int before = nice_of_this_thread();
  const std::string session_before = session_line();
  {
    const RaisedThread raised;
    EXPECT_EQ(nice_of_this_thread(), -10);
    int started = 0;
    std::thread([&started] { started = nice_of_this_thread(); }).join();
    EXPECT_EQ(started, -10);
  }
  EXPECT_EQ(nice_of_this_thread(), before);
  EXPECT_EQ(session_line(), session_before);
}

TEST(ThreadPriority, TheLastOfTwoFlightsRestoresTheSession) {
  if (!may_raise()) GTEST_SKIP() << "needs root or CAP_SYS_NICE";
  const std::string session_before = session_line();
  if (session_before.empty()) GTEST_SKIP() << "this kernel has no session groups";
  {
    const RaisedThread first;
    std::thread([] { const RaisedThread second; }).join();
    EXPECT_NE(session_line().find("nice -10"), std::string::npos) << session_line();
  }
  EXPECT_EQ(session_line(), session_before);
}

}  // namespace
}  // namespace overfly::server
