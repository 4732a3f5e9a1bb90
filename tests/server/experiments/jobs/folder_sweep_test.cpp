// Sweeps flown through a job folder by workers that vanish, freeze and come back: no flight is
// lost, and none counts twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/server/experiments/jobs/folder_sweep_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::write_text;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kTwelve =
    R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 15, 20, 25]}],
       "repeats": {"most": 3})";

TEST_F(FolderSweep, ThreeWorkersFlyEachFlightOnce) {
  write_program("sleep 0.05");
  const Sweep twelve = sweep(kTwelve);
  control(twelve);
  std::vector<std::thread> threads;
  std::atomic<std::size_t> delivered{0};
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      JobWorker own = worker();
      EXPECT_TRUE(step_until_over(own));
      delivered += own.flown();
    });
  }
  for (std::thread& thread : threads) thread.join();
  const FlownSweep& flown = finished();
  EXPECT_EQ(flights(), 12U);
  EXPECT_EQ(delivered, 12U);
  EXPECT_EQ(flights_of(flown, folder()), 12);
  EXPECT_TRUE(fs::exists(folder() / "jobs/closed"));
  for (const char* kind : {"open", "taken", "delivered", "flights"}) {
    EXPECT_TRUE(fs::is_empty(folder() / "jobs" / kind)) << kind;
  }
  EXPECT_TRUE(fs::exists(folder() / flown.results.newest().front()->run / "manifest.json"));
}

TEST_F(FolderSweep, AnEstimatorThatNeverRanHasNoResultFromAWorkerEither) {
  const fs::path without = own_folder() / "without";
  copy_run_without({"p", "q"}, without);
  write_program("cp -r '" + without.string() + "' \"$4\"; exit 1");
  const Sweep two = sweep(std::string(kTwoSpeeds) + R"(, "retries": 0)");
  control(two);
  JobWorker own = worker();
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 0);
  EXPECT_THAT(warnings_, Contains(HasSubstr("estimator p never ran: there is no such file")));
  write_program();
  control(two);
  JobWorker other = worker();
  ASSERT_TRUE(step_until_over(other));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
}

/// Killed with SIGKILL, or its machine lost: its process and its flight end without a word.
TEST_F(FolderSweep, AFlightOfAWorkerThatVanishesIsFlownAgain) {
  write_program("if [ ! -e '" + (own_folder() / "began").string() + "' ]; then touch '" +
                (own_folder() / "began").string() + "'; exec sleep 1000; fi");
  const Sweep two = sweep(kTwoSpeeds);
  control(two, kShortLease_s);
  {
    JobWorker vanishing = worker();
    ASSERT_TRUE(step_until(vanishing, [&] { return fs::exists(own_folder() / "began"); }));
  }  // Not stopped: it does not give its flight back.
  JobWorker other = worker();
  ASSERT_TRUE(step_until_over(other));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_GE(flights(), 3U) << "the first one began twice";
  EXPECT_THAT(warnings_, Contains(HasSubstr("has not been heard of for")));
}

TEST_F(FolderSweep, AFrozenWorkerThatWakesDeliversNothing) {
  write_program("if [ ! -e '" + (own_folder() / "began").string() + "' ]; then touch '" +
                (own_folder() / "began").string() + "'; sleep 0.3; fi");
  const Sweep two = sweep(kTwoSpeeds);
  control(two, kShortLease_s);
  JobWorker frozen = worker();
  ASSERT_TRUE(step_until(frozen, [&] { return fs::exists(own_folder() / "began"); }));
  // It is not stepped: its flight ends, but it does not notice. Another one flies both.
  JobWorker other = worker();
  ASSERT_TRUE(step_until_over(other));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  const std::string results = read_text(folder() / "results.jsonl");
  ASSERT_TRUE(frozen.step().ok());
  ASSERT_TRUE(frozen.step().ok());
  EXPECT_EQ(frozen.flown(), 0U);
  EXPECT_EQ(frozen.flying(), 0U);
  EXPECT_TRUE(fs::is_empty(folder() / "jobs/delivered"));
  EXPECT_TRUE(fs::is_empty(folder() / "jobs/flights"));
  EXPECT_EQ(read_text(folder() / "results.jsonl"), results);
  EXPECT_EQ(std::count(results.begin(), results.end(), '\n'), 2);
}

/// Preempted or cancelled (SIGTERM): the flight is free at once, without waiting for the lease.
TEST_F(FolderSweep, AStoppedWorkerGivesItsFlightBack) {
  write_program("if [ ! -e '" + (own_folder() / "began").string() + "' ]; then touch '" +
                (own_folder() / "began").string() + "'; exec sleep 1000; fi");
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  JobWorker stopped = worker();
  ASSERT_TRUE(step_until(stopped, [&] { return fs::exists(own_folder() / "began"); }));
  ASSERT_TRUE(stopped.stop().ok());
  JobWorker other = worker();
  ASSERT_TRUE(step_until_over(other));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_THAT(warnings_, Contains(HasSubstr("has ended; its flight is flown again")));
}

TEST_F(FolderSweep, AFlightThatEndsItsWorkerEachTimeIsNotFlownForEver) {
  write_program("echo x >> '" + (own_folder() / "begun").string() + "'; exec sleep 1000");
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}],
                             "retries": 0)");
  control(one, kShortLease_s);
  for (std::size_t begun = 1; begun <= 6; ++begun) {
    JobWorker vanishing = worker();
    ASSERT_TRUE(step_until(vanishing, [&] { return flights() >= begun; })) << begun;
  }
  const FlownSweep& flown = finished();
  EXPECT_EQ(flown.progress.failed, 1U);
  ASSERT_THAT(flown.results.newest(), SizeIs(1));
  EXPECT_THAT(flown.results.newest().front()->error, HasSubstr("6 attempts to fly it were lost"));
}

/// The controller is killed while workers fly. The next one takes their flights over.
TEST_F(FolderSweep, ANewControllerTakesJobsOver) {
  write_program("sleep 1");
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  JobWorker busy = worker(2);
  ASSERT_TRUE(step_until(busy, [&] { return flights() == 2; }));
  // What a killed controller leaves: the jobs, without results.
  const fs::path kept = own_folder() / "kept";
  fs::create_directory(kept);
  for (const char* part : {"jobs", "scenarios", "sweep.json"}) {
    fs::copy(folder() / part, kept / part, fs::copy_options::recursive);
  }
  cancel_ = true;
  (void)finished();
  cancel_ = false;
  fs::remove_all(folder());
  fs::rename(kept, folder());
  control(two);
  ASSERT_TRUE(step_until_over(busy));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_EQ(flights(), 2U) << "none was flown again";
  EXPECT_EQ(busy.flown(), 2U);
}

/// It is stopped before it has read the folder: by Ctrl-C, or because nothing is due any more.
TEST_F(FolderSweep, AControllerThatStopsAtOnceTakesBackWhatAnEarlierOneLeft) {
  const JobFolder jobs(folder());
  ASSERT_TRUE(jobs.create().ok());
  const std::string left = "000001-0123abcd";
  const std::string given_up = "000002-0123abcd";
  ASSERT_TRUE(jobs.publish({left, "ab", kVersion, 1.0, {}}).ok());
  for (const std::string& id : {left, given_up}) fs::create_directories(jobs.run(id));
  FolderExecutorOptions executor_options;
  executor_options.version = kVersion;
  const auto executor = FolderExecutor::open(folder(), std::move(executor_options));
  ASSERT_TRUE(executor.ok()) << executor.error().message;
  EXPECT_TRUE(jobs.is_open(left));
  EXPECT_TRUE(fs::exists(jobs.run(left)));
  EXPECT_FALSE(fs::exists(jobs.run(given_up)));
  (*executor)->stop();
  EXPECT_THAT(*jobs.open_jobs(), IsEmpty());
  EXPECT_TRUE(fs::is_empty(folder() / "jobs/flights"));
}

TEST_F(FolderSweep, CellsWithTheSameFlightAreOneJob) {
  write_program("sleep 0.2");
  const Sweep seeds =
      sweep(R"("axes": [{"path": "seed", "values": [1, 2, 3]}], "repeats": {"most": 3})");
  control(seeds);
  JobWorker own = worker(3);
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 9);
  EXPECT_EQ(flights(), 5U);
}

TEST_F(FolderSweep, CancellingEndsTheFlightsOfTheWorkers) {
  write_program("exec sleep 1000");
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  JobWorker busy = worker(2);
  ASSERT_TRUE(step_until(busy, [&] { return flights() == 2; }));
  cancel_ = true;
  EXPECT_TRUE(finished().cancelled);
  ASSERT_TRUE(step_until(busy, [&] { return busy.flying() == 0; }));
  EXPECT_FALSE(*busy.step()) << "the sweep is closed";
  EXPECT_TRUE(fs::is_empty(folder() / "jobs/flights"));
}

TEST_F(FolderSweep, AFailedFlightIsRetriedAndReportedWithItsWords) {
  write_program("echo 'no such world' >&2; exit 1");
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}])");
  control(one);
  JobWorker own = worker();
  ASSERT_TRUE(step_until_over(own));
  const FlownSweep& flown = finished();
  EXPECT_EQ(flights(), 2U);
  ASSERT_THAT(flown.results.newest(), SizeIs(1));
  EXPECT_EQ(flown.results.newest().front()->error, "exit code 1: no such world");
}

TEST_F(FolderSweep, ALateDeliveryOfAnEarlierAttemptIsRemoved) {
  write_program("sleep 0.3");
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  const JobFolder jobs(folder());
  const std::string earlier = "00ffff-0123abcd";
  // The run first, as a worker does: the controller removes both as soon as it sees the delivery.
  fs::create_directories(jobs.run(earlier));
  ASSERT_TRUE(jobs.deliver({earlier, "gone", 1.0, false, ""}).ok());
  JobWorker own = worker();
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_TRUE(fs::is_empty(folder() / "jobs/delivered"));
  EXPECT_FALSE(fs::exists(jobs.run(earlier)));
}

TEST_F(FolderSweep, JobsOfAnotherVersionOrForMoreMemoryAreLeft) {
  write_program();
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}])");
  control(one);
  const JobFolder jobs(folder());
  ASSERT_TRUE(jobs.publish({"00fffe-0123abcd", "ab", "0.0.1 old", 1.0, {}}).ok());
  ASSERT_TRUE(jobs.publish({"00ffff-0123abcd", "ab", kVersion, 1.0, {1ULL << 50U, 0}}).ok());
  JobWorker own = worker();
  ASSERT_TRUE(step_until(own, [&] { return worker_warnings_.size() >= 2; }));
  EXPECT_THAT(worker_warnings_, Contains(HasSubstr("is for version 0.0.1 old of the program")));
  EXPECT_THAT(worker_warnings_, Contains(HasSubstr("needs more memory than this machine has")));
  EXPECT_FALSE(jobs.holder("00fffe-0123abcd").value().has_value());
  EXPECT_FALSE(jobs.holder("00ffff-0123abcd").value().has_value());
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 1);
}

TEST_F(FolderSweep, AWorkerWhoseFolderVanishesEndsWithAnError) {
  write_program();
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}])");
  control(one);
  JobWorker own = worker();
  ASSERT_TRUE(step_until_over(own));
  (void)finished();
  fs::remove_all(folder() / "jobs");
  Result<bool> more = true;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (more && std::chrono::steady_clock::now() < end) more = own.step();
  ASSERT_FALSE(more.ok());
  EXPECT_THAT(more.error().message, HasSubstr("/out/jobs/"));
}

/// Somebody cleans the folder, or a file system loses a file.
TEST_F(FolderSweep, AJobWhoseFilesVanishIsFlownAgain) {
  write_program("sleep 0.3");
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  const JobFolder jobs(folder());
  JobWorker own = worker();
  ASSERT_TRUE(step_until(own, [&] { return flights() == 1; }));
  const std::vector<std::string> open = jobs.open_jobs().value();
  for (const std::string& id : open) ASSERT_TRUE(jobs.withdraw(id).ok());
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_THAT(warnings_, Contains(HasSubstr("was removed from outside")));
}

/// A shared file system may show a file's name before its content, or lose the content.
TEST_F(FolderSweep, AJobWhoseFileIsDamagedIsPublishedAgain) {
  write_program();
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  const JobFolder jobs(folder());
  const std::string id = jobs.open_jobs()->back();
  write_text(folder() / "jobs/open" / (id + ".json"), "{");
  JobWorker own = worker();
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_FALSE(jobs.is_open(id));
  EXPECT_THAT(warnings_, Contains(HasSubstr(id + ".json")));
}

/// A read that fails once does not make a worker leave the flight for good.
TEST_F(FolderSweep, AWorkerReadsAJobAgainThatItCouldNotRead) {
  write_program();
  fs::create_directories(folder());
  write_text(folder() / "sweep.json", "{}");
  JobWorker own = worker();
  const JobFolder jobs(folder());
  ASSERT_TRUE(jobs.publish({"000000-0123abcd", "ab", kVersion, 1.0, {}}).ok());
  const fs::path file = folder() / "jobs/open/000000-0123abcd.json";
  const std::string text = read_text(file);
  write_text(file, text.substr(0, text.size() / 2));
  ASSERT_TRUE(step_until(own, [&] { return !worker_warnings_.empty(); }));
  EXPECT_THAT(worker_warnings_, Contains(HasSubstr("000000-0123abcd.json")));
  write_text(file, text);
  ASSERT_TRUE(step_until(own, [&] { return flights() == 1; }));
  EXPECT_THAT(worker_warnings_, SizeIs(1));
}

/// A worker that lives but does not know its flight any more must not keep it for ever.
TEST_F(FolderSweep, AJobThatItsWorkerDoesNotNameIsFlownAgain) {
  write_program();
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}])");
  control(one, kShortLease_s);
  const JobFolder jobs(folder());
  ASSERT_TRUE(*jobs.take(jobs.open_jobs()->at(0), "forgetful"));
  JobWorker own = worker();
  std::size_t beat = 0;
  ASSERT_TRUE(step_until(own, [&] {
    EXPECT_TRUE(jobs.show_worker({"forgetful", ++beat, false, {}}).ok());
    return over_.load();
  }));
  EXPECT_EQ(flights_of(finished(), folder()), 1);
  EXPECT_THAT(warnings_, Contains(HasSubstr("flies, but no longer this flight")));
}

TEST_F(FolderSweep, AJobTakenByADamagedFileIsFlownAgain) {
  write_program();
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}])");
  control(one, kShortLease_s);
  const JobFolder jobs(folder());
  overfly::testing::write_text(folder() / "jobs/taken" / jobs.open_jobs()->at(0), "{");
  JobWorker own = worker();
  ASSERT_TRUE(step_until_over(own));
  EXPECT_EQ(flights_of(finished(), folder()), 1);
}

TEST_F(FolderSweep, AWorkerWaitsForTheNextCallOfAClosedSweep) {
  write_program();
  const Sweep one = sweep(R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10]}])");
  control(one);
  JobWorker first = worker();
  ASSERT_TRUE(step_until_over(first));
  (void)finished();
  EXPECT_FALSE(*first.step()) << "the sweep is over";
  JobWorker early = worker();
  EXPECT_TRUE(*early.step()) << "the next call may begin";
  const Sweep two = sweep(kTwoSpeeds);
  control(two);
  ASSERT_TRUE(step_until_over(early));
  EXPECT_EQ(flights_of(finished(), folder()), 2);
  EXPECT_EQ(early.flown(), 1U);
}

TEST_F(FolderSweep, AWorkerNeedsASweep) {
  WorkerOptions worker_options;
  worker_options.sweep = own_folder() / "nothing";
  const Result<JobWorker> started = JobWorker::start(std::move(worker_options));
  ASSERT_FALSE(started.ok());
  EXPECT_EQ(started.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(started.error().message, HasSubstr("sweep.json is missing"));
}

}  // namespace
}  // namespace overfly::server::experiments
