// Threads that the system refuses: whichever of a run's threads it is, the run ends by itself and
// the program goes on; so does the build of a world.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <filesystem>

#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/run/run_options.hpp"
#include "terrain/build_world.hpp"
#include "terrain/world.hpp"
#include "tests/server/support/manager_fixture.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define OVERFLY_THREADS_CAN_BE_REFUSED 0  // the sanitizer replaces pthread_create
#else
#define OVERFLY_THREADS_CAN_BE_REFUSED 1
#endif

namespace {

/// The thread to refuse, counted from 1 in the order of their starts; 0 = none.
std::atomic<int> refused_thread{0};

}  // namespace

#if OVERFLY_THREADS_CAN_BE_REFUSED
/// Stands before the system's own for the whole program.
extern "C" int pthread_create(pthread_t* thread,
                              const pthread_attr_t* attributes,
                              void* (*start)(void*),
                              void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
  if (refused_thread > 0 && --refused_thread == 0) return EAGAIN;
  return create(thread, attributes, start, argument);
}
#endif

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

class ThreadFailure : public testing::ManagerTest {
 protected:
  void SetUp() override {
    if (OVERFLY_THREADS_CAN_BE_REFUSED == 0) GTEST_SKIP() << "not with this sanitizer";
  }
  void TearDown() override { refused_thread = 0; }
};

TEST_F(ThreadFailure, RunEndsByItselfWhicheverThreadIsRefused) {
  int failed = 0;
  int completed = 0;
  const Scenario scenario = testing::small_scenario(
      {"duration_s=0.3",
       R"(estimators=[{"name":"p","type":"perfect"},{"name":"d","type":"drifting"}])"});
  for (int n = 1; n <= 12; ++n) {
    const TemporaryFolder folder;
    RunOptions options;
    options.folder = folder.path() / "r";
    options.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles) {
      renderer::RendererOptions threads;
      threads.threads = 3;
      return Result<std::unique_ptr<renderer::Renderer>>(
          renderer::create_raycast_renderer(std::move(tiles), threads));
    };
    refused_thread = n;
    const auto run = run_scenario(scenario, options);
    refused_thread = 0;
    const auto info = read_run_info(options.folder);
    ASSERT_TRUE(info.ok()) << info.error().message;
    EXPECT_FALSE(RunLock::held(options.folder));
    if (run.ok()) {
      EXPECT_EQ(info->status, RunStatus::kCompleted);
      EXPECT_EQ(info->frames, 4);
      ++completed;
    } else {
      EXPECT_EQ(info->status, RunStatus::kFailed);
      EXPECT_THAT(info->error, HasSubstr("too many threads?"));
      ++failed;
    }
  }
  EXPECT_GE(failed, 2) << "an estimator's";
  EXPECT_GE(completed, 2) << "one that others can do without";
}

TEST_F(ThreadFailure, AWorldIsBuiltByTheThreadsThatThereAre) {
  int completed = 0;
  for (int n = 1; n <= 3; ++n) {
    const TemporaryFolder folder;
    const std::filesystem::path world = folder.path() / "world";
    std::filesystem::copy(
        testing::small_world().parent_path(), world, std::filesystem::copy_options::recursive);
    const auto spec = terrain::read_world_manifest(world / testing::small_world().filename());
    ASSERT_TRUE(spec.ok()) << spec.error().message;
    refused_thread = n;
    const auto built = terrain::build_world(*spec);
    refused_thread = 0;
    if (built.ok()) {
      ++completed;
    } else {
      EXPECT_THAT(built.error().message, HasSubstr("no thread can be started"));
    }
  }
  EXPECT_GE(completed, 2);
}

TEST_F(ThreadFailure, ManagerThatCannotStartItsThreadsSaysSo) {
  RunManagerOptions two = options();
  two.max_parallel_runs = 2;
  for (int n = 1; n <= 3; ++n) {
    refused_thread = n;
    const auto runs = RunManager::create(two);
    ASSERT_FALSE(runs.ok());
    EXPECT_THAT(runs.error().message, HasSubstr("thread " + std::to_string(n) + " of 3"));
  }
}

}  // namespace
}  // namespace overfly::server
