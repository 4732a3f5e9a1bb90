// Flights that reach their limit of time, flown by a program that a test writes.
#include "server/experiments/flights/flight_process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;

TEST(FlightProcesses, AFlightAtItsLimitMayEndItsEstimators) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path program = folder.path() / "program";
  overfly::testing::write_text(program,
                               "#!/bin/sh\ncd '" + folder.path().string() +
                                   "'\ntrap 'kill $!; touch ended; exit 3' TERM\nsleep 1000 &\n" +
                                   "touch ready\nwait\n");
  fs::permissions(program, fs::perms::owner_all);
  FlightProcesses processes(program);
  FlightJob job;
  job.id = "a";
  job.output = folder.path() / "output.txt";
  ASSERT_TRUE(processes.start(job).ok());
  while (!fs::exists(folder.path() / "ready")) std::this_thread::yield();
  std::optional<EndedFlight> ended;
  while (!ended) ended = processes.ended().value();
  EXPECT_TRUE(ended->timed_out);
  EXPECT_EQ(ended->reason, "exit code 3");
  EXPECT_TRUE(fs::exists(folder.path() / "ended"));
}

}  // namespace
}  // namespace overfly::server::experiments
