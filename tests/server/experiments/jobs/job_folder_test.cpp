// The job folder: one worker gets a job, and files that are no jobs do no harm.
#include "server/experiments/jobs/job_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kJob = "000001-0123abcd";

class JobFolderTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(jobs_.create().ok()); }
  static OpenJob job(const std::string& id) {
    return {id, "0123456789abcdef", "0.1.0 abc", 60.0, {1000, 2000}};
  }

  TemporaryFolder folder_;
  JobFolder jobs_{folder_.path()};
};

TEST_F(JobFolderTest, AJobIsReadAsItWasPublished) {
  ASSERT_TRUE(jobs_.publish(job(kJob)).ok());
  const Result<OpenJob> read = jobs_.read_job(kJob);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->flight, "0123456789abcdef");
  EXPECT_EQ(read->version, "0.1.0 abc");
  EXPECT_EQ(read->timeout_s, 60.0);
  EXPECT_EQ(read->memory.images_bytes, 1000U);
  EXPECT_EQ(read->memory.caches_bytes, 2000U);
}

TEST_F(JobFolderTest, OneOfManyWorkersTakesAJob) {
  constexpr int kRounds = 50;
  constexpr int kWorkers = 8;
  for (int round = 0; round < kRounds; ++round) {
    const std::string id = "00000" + std::to_string(round % 10) + "-" + random_name();
    std::atomic<int> taken{0};
    std::vector<std::thread> workers;
    for (int i = 0; i < kWorkers; ++i) {
      workers.emplace_back([&, i] {
        const Result<bool> mine = jobs_.take(id, "worker-" + std::to_string(i));
        if (mine && *mine) ++taken;
      });
    }
    for (std::thread& worker : workers) worker.join();
    EXPECT_EQ(taken, 1);
    EXPECT_TRUE(jobs_.holder(id).value().has_value());
  }
}

TEST_F(JobFolderTest, AWithdrawnJobLeavesNoFiles) {
  ASSERT_TRUE(jobs_.publish(job(kJob)).ok());
  ASSERT_TRUE(*jobs_.take(kJob, "w-1"));
  fs::create_directories(jobs_.run(kJob));
  write_text(jobs_.output(kJob), "text");
  ASSERT_TRUE(jobs_.withdraw(kJob).ok());
  EXPECT_FALSE(jobs_.is_open(kJob));
  EXPECT_FALSE(jobs_.holder(kJob).value().has_value());
  EXPECT_THAT(*jobs_.taken(), IsEmpty());
  EXPECT_FALSE(fs::exists(jobs_.run(kJob)));
  EXPECT_FALSE(fs::exists(jobs_.output(kJob)));
}

/// The process of a worker that has not noticed yet.
TEST_F(JobFolderTest, AJobIsWithdrawnWhileItsFlightIsWritten) {
  std::atomic<bool> over{false};
  std::thread writer([&] {
    const fs::path run = jobs_.run(kJob);
    std::error_code ignored;
    for (std::size_t i = 0; !over; ++i) {
      fs::create_directories(run / std::to_string(i), ignored);
      // Slower than they are removed.
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(jobs_.publish(job(kJob)).ok());
    const Status withdrawn = jobs_.withdraw(kJob);
    EXPECT_TRUE(withdrawn.ok()) << withdrawn.error().message;
  }
  over = true;
  writer.join();
  EXPECT_FALSE(jobs_.is_open(kJob));
}

TEST_F(JobFolderTest, FlightsOfOtherJobsAreRemoved) {
  const std::string other = "000002-0123abcd";
  for (const std::string& id : {std::string(kJob), other}) {
    fs::create_directories(jobs_.run(id) / "images");
    write_text(jobs_.output(id), "text");
  }
  jobs_.remove_flights_except({kJob});
  EXPECT_TRUE(fs::exists(jobs_.run(kJob)));
  EXPECT_TRUE(fs::exists(jobs_.output(kJob)));
  EXPECT_FALSE(fs::exists(jobs_.run(other)));
  EXPECT_FALSE(fs::exists(jobs_.output(other)));
}

TEST_F(JobFolderTest, AReleasedJobIsTakenByAnotherWorker) {
  ASSERT_TRUE(jobs_.publish(job(kJob)).ok());
  ASSERT_TRUE(*jobs_.take(kJob, "w-1"));
  ASSERT_FALSE(*jobs_.take(kJob, "w-2"));
  ASSERT_TRUE(jobs_.release(kJob).ok());
  EXPECT_TRUE(jobs_.is_open(kJob));
  EXPECT_TRUE(*jobs_.take(kJob, "w-2"));
}

TEST_F(JobFolderTest, OtherFilesAreNoJobs) {
  ASSERT_TRUE(jobs_.publish(job(kJob)).ok());
  for (const char* name : {"x.json",
                           "000001-0123abcd.json.part",
                           "000001-0123ABCD.json",
                           "0000010-123abcd.json",
                           "000001_0123abcd.json"}) {
    write_text(folder_.path() / "jobs/open" / name, "{}");
  }
  EXPECT_THAT(*jobs_.open_jobs(), ElementsAre(kJob));
  EXPECT_THAT(*jobs_.taken(), IsEmpty());
  EXPECT_THAT(*jobs_.delivered(), IsEmpty());
}

TEST_F(JobFolderTest, WorkersThatHoldNothingAreRemoved) {
  ASSERT_TRUE(jobs_.show_worker({"w-1", 3, true, {}}).ok());
  ASSERT_TRUE(jobs_.show_worker({"w-2", 4, false, {kJob}}).ok());
  ASSERT_TRUE(jobs_.remove_workers_except({"w-2"}).ok());
  EXPECT_FALSE(jobs_.worker("w-1").has_value());
  ASSERT_TRUE(jobs_.worker("w-2").has_value());
  EXPECT_THAT(jobs_.worker("w-2")->jobs, ElementsAre(kJob));
}

TEST_F(JobFolderTest, DamagedJobsAreRefusedWithFileAndField) {
  const fs::path file = folder_.path() / "jobs/open" / (std::string(kJob) + ".json");
  const std::pair<const char*, const char*> cases[] = {
      {"{", "open/000001-0123abcd.json"},
      {"[]", "is no JSON object"},
      {R"({"flight": 1})", "flight has a value of another type"},
      {R"({"flight": "../../x", "version": "", "timeout_s": 1, "images_bytes": 0, "caches_bytes": 0})",
       "flight is no digest"},
      {R"({"flight": "ab", "version": "", "timeout_s": 0, "images_bytes": 0, "caches_bytes": 0})",
       "timeout_s must be above 0"},
      {R"({"flight": "ab", "version": "", "timeout_s": 1, "images_bytes": 0})",
       "caches_bytes is missing"}};
  for (const auto& [text, message] : cases) {
    write_text(file, text);
    const Result<OpenJob> read = jobs_.read_job(kJob);
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_THAT(read.error().message, HasSubstr(message)) << text;
  }
}

TEST_F(JobFolderTest, ADamagedHolderWorkerOrDeliveryIsReported) {
  write_text(folder_.path() / "jobs/taken" / kJob, R"({"worker": "../../etc/passwd"})");
  EXPECT_THAT(*jobs_.taken(), ElementsAre(kJob));
  ASSERT_FALSE(jobs_.holder(kJob).ok());
  EXPECT_THAT(jobs_.holder(kJob).error().message, HasSubstr("worker is no name of a worker"));
  for (const char* text : {R"({"beat": "x", "over": false, "jobs": []})",
                           R"({"beat": 1, "over": false, "jobs": [1]})",
                           R"({"beat": 1, "over": false})"}) {
    write_text(folder_.path() / "jobs/workers/w.json", text);
    EXPECT_FALSE(jobs_.worker("w").has_value()) << text;
  }
  write_text(folder_.path() / "jobs/delivered" / (std::string(kJob) + ".json"),
             R"({"worker": "w", "duration_s": -1, "timed_out": false, "reason": ""})");
  ASSERT_FALSE(jobs_.read_delivery(kJob).ok());
  EXPECT_THAT(jobs_.read_delivery(kJob).error().message, HasSubstr("duration_s must not be"));
}

}  // namespace
}  // namespace overfly::server::experiments
