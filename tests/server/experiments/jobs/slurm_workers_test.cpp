// Tasks of Slurm, with programs in place of its commands: refusals, silence, tasks that end.
#include "server/experiments/jobs/slurm_workers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "server/experiments/jobs/command_output.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SlurmWorkersTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = std::getenv("PATH");
    ::setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1);
    command("sbatch", "echo 17");
    command("squeue", "cat '" + queue().string() + "'");
    command("scancel", "");
    write_text(queue(), "");
  }
  void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }

  /// A command that writes its arguments to `calls` and goes on with `text`.
  void command(const std::string& name, const std::string& text) {
    const fs::path file = folder_.path() / name;
    write_text(file,
               "#!/bin/sh\n[ \"$1\" = --version ] && exit 0\necho \"" + name + " $*\" >> '" +
                   calls().string() + "'\n" + text + "\n");
    fs::permissions(file, fs::perms::owner_all);
  }
  void set_tasks(int tasks) {
    std::string text;
    for (int i = 0; i < tasks; ++i) text += "17_" + std::to_string(i) + "|RUNNING|None\n";
    write_text(queue(), text);
  }
  std::unique_ptr<SlurmWorkers> open(std::size_t workers = 4) {
    SlurmOptions options;
    options.sweep = folder_.path() / "it's a sweep";
    options.program = "/opt/over fly";
    options.workers = workers;
    options.submit_options = {"--partition=long"};
    options.period_s = 0.0;
    options.patience_s = 0.0;
    options.warn = [this](const std::string& text) { warnings_.push_back(text); };
    auto opened = SlurmWorkers::open(std::move(options));
    EXPECT_TRUE(opened.ok()) << (opened.ok() ? "" : opened.error().message);
    return std::move(*opened);
  }
  [[nodiscard]] std::vector<std::string> submissions() const {
    std::vector<std::string> lines;
    if (!fs::exists(calls())) return lines;
    std::istringstream text(read_text(calls()));
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("sbatch")) lines.push_back(line);
    }
    return lines;
  }
  [[nodiscard]] fs::path calls() const { return folder_.path() / "calls"; }
  [[nodiscard]] fs::path queue() const { return folder_.path() / "queue"; }

  TemporaryFolder folder_;
  std::string path_;
  std::vector<std::string> warnings_;
};

constexpr RunMemory kMemory{std::uint64_t{100} << 20U, std::uint64_t{400} << 20U};

TEST_F(SlurmWorkersTest, SubmitsWhatIsMissingUpToTheLimit) {
  const auto workers = open(4);
  ASSERT_TRUE(workers->keep({3, 3, 0}, kMemory).ok());
  ASSERT_EQ(submissions().size(), 1U);
  EXPECT_THAT(submissions()[0], HasSubstr("--array=0-2 --mem=1012M"));
  EXPECT_THAT(submissions()[0], HasSubstr("--partition=long"));
  EXPECT_THAT(submissions()[0], HasSubstr("--requeue"));
  set_tasks(3);
  ASSERT_TRUE(workers->keep({3, 3, 0}, kMemory).ok());
  EXPECT_EQ(submissions().size(), 1U) << "all are there";
  ASSERT_TRUE(workers->keep({10, 10, 1}, kMemory).ok());
  ASSERT_EQ(submissions().size(), 2U);
  EXPECT_THAT(submissions()[1], HasSubstr("--array=0-0 ")) << "one more, up to four";
  ASSERT_TRUE(workers->keep({0, 0, 10}, kMemory).ok());
  EXPECT_EQ(submissions().size(), 2U) << "nothing is left to fly";
}

TEST_F(SlurmWorkersTest, AThousandTasksAreOneArray) {
  const auto workers = open(2500);
  ASSERT_TRUE(workers->keep({3000, 3000, 0}, kMemory).ok());
  EXPECT_THAT(submissions().at(0), HasSubstr("--array=0-999 "));
  set_tasks(1000);
  ASSERT_TRUE(workers->keep({3000, 3000, 0}, kMemory).ok());
  EXPECT_THAT(submissions().at(1), HasSubstr("--array=0-999 "));
  set_tasks(2000);
  ASSERT_TRUE(workers->keep({3000, 3000, 0}, kMemory).ok());
  EXPECT_THAT(submissions().at(2), HasSubstr("--array=0-499 "));
}

TEST_F(SlurmWorkersTest, TheScriptIsTheWorker) {
  const auto workers = open();
  const fs::path file = folder_.path() / "it's a sweep/jobs/slurm/worker.sh";
  EXPECT_THAT(read_text(file),
              HasSubstr("exec '/opt/over fly' sweep work '" + folder_.path().string() +
                        "/it'\\''s a sweep' --jobs 1"));
}

TEST_F(SlurmWorkersTest, TheFirstTasksAreTriedThreeTimes) {
  command("sbatch", "echo 'sbatch: error: invalid partition specified: long' >&2; exit 1");
  const auto workers = open();
  EXPECT_TRUE(workers->keep({1, 1, 0}, kMemory).ok());
  EXPECT_TRUE(workers->keep({1, 1, 0}, kMemory).ok());
  const Status third = workers->keep({1, 1, 0}, kMemory);
  ASSERT_FALSE(third.ok());
  EXPECT_THAT(third.error().message,
              HasSubstr("sbatch: exit code 1: sbatch: error: invalid partition specified: long"));
}

TEST_F(SlurmWorkersTest, LaterRefusalsAreWarningsOnly) {
  const auto workers = open();
  ASSERT_TRUE(workers->keep({1, 1, 0}, kMemory).ok());
  command("sbatch", "echo 'sbatch: error: Unable to contact slurm controller' >&2; exit 1");
  for (std::size_t i = 1; i <= 10; ++i) EXPECT_TRUE(workers->keep({1, 1, i}, kMemory).ok());
  EXPECT_THAT(warnings_, Contains(HasSubstr("Unable to contact slurm controller")));
  command("sbatch", "echo 18");
  ASSERT_TRUE(workers->keep({1, 1, 20}, kMemory).ok());
  EXPECT_THAT(submissions().back(), HasSubstr("--array=0-0"));
}

/// While the queue does not answer, nobody knows whether the tasks live: none is added.
TEST_F(SlurmWorkersTest, ASilentQueueIsReportedOnceAndNothingIsSubmitted) {
  const auto workers = open();
  ASSERT_TRUE(workers->keep({1, 1, 0}, kMemory).ok());
  command("squeue", "echo 'slurm_load_jobs error: Unable to contact slurm controller'; exit 1");
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(workers->keep({4, 4, 0}, kMemory).ok());
  EXPECT_EQ(submissions().size(), 1U);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("Unable to contact slurm controller")));
  command("squeue", "cat '" + queue().string() + "'");
  set_tasks(1);
  ASSERT_TRUE(workers->keep({1, 1, 0}, kMemory).ok());
  EXPECT_THAT(warnings_, Contains("squeue answers again"));
  EXPECT_EQ(submissions().size(), 1U);
}

/// A node with an old task of the same number cannot launch it: Slurm holds the task for ever.
TEST_F(SlurmWorkersTest, TasksThatSlurmCouldNotLaunchAreReplaced) {
  const auto workers = open();
  ASSERT_TRUE(workers->keep({2, 2, 0}, kMemory).ok());
  write_text(queue(), "17_0|PENDING|launch failed requeued held\n17_1|RUNNING|None\n");
  ASSERT_TRUE(workers->keep({2, 2, 0}, kMemory).ok());
  EXPECT_THAT(read_text(calls()),
              ::testing::ContainsRegex("scancel --name=overfly-[0-9a-f]+ "
                                       "--state=PENDING 17_0\n"));
  ASSERT_EQ(submissions().size(), 2U);
  EXPECT_THAT(submissions()[1], HasSubstr("--array=0-0 "));
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("could not launch 1 task")));
}

TEST_F(SlurmWorkersTest, SaysForWhatAllTasksWait) {
  const auto workers = open();
  const std::string down = "Nodes required for job are DOWN, DRAINED or reserved";
  for (int i = 0; i < 3; ++i) {
    write_text(queue(), "17_0|PENDING|" + down + "\n17_1|PENDING|Priority\n");
    ASSERT_TRUE(workers->keep({2, 2, 0}, kMemory).ok());
  }
  EXPECT_THAT(warnings_, ElementsAre("no task runs; Slurm's reason: " + down)) << "once";
  write_text(queue(), "17_0|RUNNING|None\n17_1|PENDING|" + down + "\n");
  ASSERT_TRUE(workers->keep({2, 2, 0}, kMemory).ok());
  EXPECT_EQ(warnings_.size(), 1U) << "one runs";
  write_text(queue(), "17_0|PENDING|JobHeldUser\n17_1|PENDING|JobHeldUser\n");
  ASSERT_TRUE(workers->keep({2, 2, 0}, kMemory).ok());
  EXPECT_EQ(warnings_.back(), "no task runs; Slurm's reason: JobHeldUser");
  EXPECT_TRUE(submissions().empty()) << "what somebody holds is not replaced";
}

TEST_F(SlurmWorkersTest, OnlyNumbersOfTasksAreCancelled) {
  const auto workers = open();
  write_text(queue(), "--user=root|PENDING|launch failed requeued held\n|||\n\n17_2\n");
  ASSERT_TRUE(workers->keep({1, 1, 0}, kMemory).ok());
  EXPECT_THAT(read_text(calls()), ::testing::Not(HasSubstr("scancel")));
}

TEST_F(SlurmWorkersTest, TasksThatEndWithoutAFlightAreAnError) {
  const auto workers = open();
  Status status;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(status.ok());
    status = workers->keep({2, 2, 0}, kMemory);
  }
  ASSERT_TRUE(status.ok());
  status = workers->keep({2, 2, 0}, kMemory);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("ended 3 times without a flight; see "));
}

/// Its flight is free again when the lease is over: until then no task could fly anything.
TEST_F(SlurmWorkersTest, FlightsOfAKilledWorkerAreWaitedFor) {
  const auto workers = open();
  for (int killed = 0; killed < 5; ++killed) {
    ASSERT_TRUE(workers->keep({2, 1, 0}, kMemory).ok());
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(workers->keep({2, 0, 0}, kMemory).ok()) << i;
  }
  ASSERT_EQ(submissions().size(), 5U);
  EXPECT_THAT(submissions().back(), HasSubstr("--array=0-0 ")) << "for the one that is free";
}

/// Of which a worker keeps a fifth for everything else (MemoryBudget::of_machine).
TEST_F(SlurmWorkersTest, ATaskHasTheMemoryThatItsWorkerDemands) {
  constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;
  for (const RunMemory& memory :
       {kMemory, RunMemory{8000 * kMib, 900 * kMib}, RunMemory{2500 * kMib, 5000 * kMib}}) {
    const auto workers = open();
    ASSERT_TRUE(workers->keep({1, 1, 0}, memory).ok());
    const std::string call = submissions().back();
    const auto mem_mib = std::stoull(call.substr(call.find("--mem=") + 6));
    const auto limit_bytes = static_cast<std::uint64_t>(0.8 * static_cast<double>(mem_mib * kMib));
    EXPECT_TRUE(MemoryBudget(limit_bytes, false).holds(memory)) << call;
    EXPECT_GE(mem_mib * kMib, memory.images_bytes + memory.caches_bytes + 512 * kMib);
  }
}

TEST_F(SlurmWorkersTest, TasksThatDeliverAreFollowedByOthers) {
  const auto workers = open();
  for (std::size_t i = 0; i < 20; ++i) ASSERT_TRUE(workers->keep({2, 2, i}, kMemory).ok()) << i;
  EXPECT_EQ(submissions().size(), 20U);
}

TEST_F(SlurmWorkersTest, TheNameIsKeptForTheNextController) {
  (void)open();
  const std::string name = read_text(folder_.path() / "it's a sweep/jobs/slurm/name.json");
  const auto workers = open();
  EXPECT_EQ(read_text(folder_.path() / "it's a sweep/jobs/slurm/name.json"), name);
  workers->stop();
  EXPECT_THAT(read_text(calls()), HasSubstr("scancel --name=overfly-"));
}

/// scancel must not be given a name that cancels other jobs.
TEST_F(SlurmWorkersTest, ADamagedNameIsRefused) {
  const fs::path file = folder_.path() / "it's a sweep/jobs/slurm/name.json";
  fs::create_directories(file.parent_path());
  for (const char* text : {"{",
                           "[]",
                           "{}",
                           R"({"job_name": 5})",
                           R"({"job_name": ""})",
                           R"({"job_name": "overfly-0123abcd,others"})",
                           R"({"job_name": "--user=root"})"}) {
    write_text(file, text);
    SlurmOptions options;
    options.sweep = folder_.path() / "it's a sweep";
    const auto opened = SlurmWorkers::open(std::move(options));
    ASSERT_FALSE(opened.ok()) << text;
    EXPECT_THAT(opened.error().message, HasSubstr("name.json")) << text;
  }
}

TEST(CommandOutput, ReturnsTextAndExitCode) {
  const auto output = command_output({"sh", "-c", "echo out; echo err >&2; exit 3"}, 10.0);
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->exit_code, 3);
  EXPECT_EQ(output->text, "out\nerr\n");
}

TEST(CommandOutput, NamesTheProgramThatIsMissingHangsOrIsKilled) {
  const auto missing = command_output({"no-such-program-here"}, 10.0);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(missing.error().message, HasSubstr("no-such-program-here: No such file"));
  const auto hanging = command_output({"sleep", "1000"}, 0.2);
  ASSERT_FALSE(hanging.ok());
  EXPECT_THAT(hanging.error().message, HasSubstr("sleep: did not end within"));
  const auto silent = command_output({"sh", "-c", "exec >&- 2>&-; exec sleep 1000"}, 0.3);
  ASSERT_FALSE(silent.ok());
  EXPECT_THAT(silent.error().message, HasSubstr("sh: did not end within"));
  const auto killed = command_output({"sh", "-c", "kill -9 $$"}, 10.0);
  ASSERT_FALSE(killed.ok());
  EXPECT_THAT(killed.error().message, HasSubstr("sh: was ended by signal 9"));
}

TEST(CommandOutput, IsLimited) {
  const auto output = command_output({"head", "-c", "20000000", "/dev/zero"}, 30.0);
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->text.size(), std::size_t{4} << 20U);
}

}  // namespace
}  // namespace overfly::server::experiments
