// Sweeps flown by a program that a test writes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "server/experiments/fly_sweep.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {

/// A program in place of overfly: `program run SCENARIO --out FOLDER --quiet` copies a run that was
/// completed before, and writes a line to `calls`.
class FlySweep : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new overfly::testing::TemporaryFolder;
    const auto run =
        run_scenario(server::testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect"},
                                                        {"name":"q","type":"perfect"}])"}),
                     server::testing::options_for(shared_->path() / "run"));
    ASSERT_TRUE(run.ok()) << run.error().message;
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }

  /// @param flight  what the program does before it copies the run
  void write_program(const std::string& flight = "") {
    overfly::testing::write_text(program(),
                                 "#!/bin/sh\nset -e\necho \"$2\" >> '" + calls().string() + "'\n" +
                                     flight + "\ncp -r '" + (shared_->path() / "run").string() +
                                     "' \"$4\"\n");
    std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
  }
  /// The run that the program copies.
  static void copy_run(const std::filesystem::path& to) {
    std::filesystem::copy(shared_->path() / "run", to, std::filesystem::copy_options::recursive);
  }
  /// The same run, in which some of its estimators ended before they answered a frame.
  static void copy_run_without(const std::vector<std::string>& estimators,
                               const std::filesystem::path& to) {
    copy_run(to);
    const std::filesystem::path file = to / "metrics.json";
    auto metrics = nlohmann::json::parse(overfly::testing::read_text(file));
    for (const std::string& name : estimators) {
      auto& estimator = metrics["estimators"][name];
      estimator["answered"] = 0;
      estimator["crash"] = "there is no such file";
      estimator["outcome"] = "CRASHED";
    }
    overfly::testing::write_text(file, metrics.dump());
  }
  Sweep sweep(const std::string& fields) {
    const std::filesystem::path file = own_.path() / "sweep.json";
    const std::filesystem::path scenario =
        std::filesystem::path(OVERFLY_SOURCE_DIR) / "scenarios/course.json";
    overfly::testing::write_text(file,
                                 R"({"format_version": 1, "scenario": ")" + scenario.string() +
                                     R"(", "estimators": [{"name": "p", "type": "perfect"}], )" +
                                     fields + "}");
    Result<Sweep> loaded = load_sweep(file);
    EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
    return std::move(*loaded);
  }
  SweepOptions options(std::size_t jobs) {
    SweepOptions options;
    options.folder = folder();
    options.program = program();
    options.jobs = jobs;
    options.cancel = &cancel_;
    options.warn = [this](const std::string& text) { warnings_.push_back(text); };
    options.progress = [this](const SweepProgress& progress) { progress_ = progress; };
    return options;
  }
  Result<FlownSweep> fly(const Sweep& sweep, std::size_t jobs = 1) {
    return fly_sweep(sweep, options(jobs));
  }
  [[nodiscard]] std::size_t flights() const {
    if (!std::filesystem::exists(calls())) return 0;
    const std::string text = overfly::testing::read_text(calls());
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  [[nodiscard]] const std::filesystem::path& own_folder() const { return own_.path(); }
  [[nodiscard]] std::filesystem::path folder() const { return own_.path() / "out"; }
  [[nodiscard]] std::filesystem::path program() const { return own_.path() / "program"; }
  [[nodiscard]] std::filesystem::path calls() const { return own_.path() / "calls"; }

  std::atomic<bool> cancel_{false};
  std::vector<std::string> warnings_;
  SweepProgress progress_;

 private:
  inline static overfly::testing::TemporaryFolder* shared_ = nullptr;
  overfly::testing::TemporaryFolder own_;
};

inline constexpr const char* kTwoSpeeds =
    R"("axes": [{"path": "flight.course.airspeed_m_s", "values": [10, 25]}])";

}  // namespace overfly::server::experiments
