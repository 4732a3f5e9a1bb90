// A run manager over an empty folder and one small scenario.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/record/run_info.hpp"
#include "server/runs/run_manager.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::testing {

class ManagerTest : public ::testing::Test {
 protected:
  ManagerTest() {
    std::filesystem::create_directories(root() / "scenarios");
    overfly::testing::write_text(root() / "scenarios" / "small.json", small_document().dump());
  }

  /// Of the fixture's folders, to be changed.
  [[nodiscard]] RunManagerOptions options() const {
    RunManagerOptions options;
    options.runs_folder = root() / "runs";
    options.scenarios_folder = root() / "scenarios";
    options.renderer_factory = noop_factory();
    return options;
  }
  [[nodiscard]] std::unique_ptr<RunManager> manager() const {
    return std::move(RunManager::create(options()).value());
  }

  /// The run's last status, once it is over.
  static RunInfo wait_for_end(RunManager& runs, const std::string& id) {
    const auto timeline = runs.timeline(id).value();
    std::uint64_t seen = 0;
    while (true) {
      seen = timeline->wait_for_change(seen, 1000);
      const RunInfo info = timeline->info();
      if (info.status != RunStatus::kQueued && info.status != RunStatus::kRunning) return info;
    }
  }
  static void wait_for_first_frame(const RunTimeline& timeline) {
    std::uint64_t seen = 0;
    while (timeline.frame_count() == 0) seen = timeline.wait_for_change(seen, 1000);
  }
  /// A short run, over.
  static std::string fly(RunManager& runs) {
    const std::string id = runs.start("small", perfect()).value().id;
    wait_for_end(runs, id);
    return id;
  }

  static std::vector<Override> perfect() {
    return {{"estimators", nlohmann::json::parse(R"([{"name":"p","type":"perfect"}])")}};
  }
  /// Flies until it is cancelled.
  static std::vector<Override> endless() { return {{"duration_s", 30}, {"camera.rate_hz", 1000}}; }
  static std::vector<std::string> ids_of(const RunList& runs) {
    std::vector<std::string> ids;
    for (const auto& run : runs) ids.push_back(run->id);
    return ids;
  }
  [[nodiscard]] std::filesystem::path folder_of(const std::string& id) const {
    return root() / "runs" / id;
  }
  [[nodiscard]] const std::filesystem::path& root() const { return folder_.path(); }

 private:
  overfly::testing::TemporaryFolder folder_;
};

}  // namespace overfly::server::testing
