// A server whose sweeps are flown by a program that the test writes.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {

/// A server whose sweeps are flown by a program in place of overfly. `program run SCENARIO --out
/// FOLDER ...` writes its arguments to `calls` and its process to `flights`, waits while there is a
/// file `block`, and copies a run that was completed before.
class SweepRoutesTest : public ::testing::Test {
 public:
  static constexpr const char* kSweepRoute = "/api/v1/sweeps";

 protected:
  SweepRoutesTest() {
    net::ServerOptions options;
    options.program = program();
    options.frame_cache_gib = 2.5;
    server_ = std::make_unique<TestServer>(options);
    const std::filesystem::path run = server_->folder() / "runs" / server_->fly("tiny");
    const std::string own = own_.path().string();
    write_text(program(),
               "#!/bin/sh\nset -e\necho \"$*\" >> '" + own + "/calls'\necho $$ >> '" + own +
                   "/flights'\nif [ -e '" + own + "/block' ]; then exec sleep 60; fi\ncp -r '" +
                   run.string() + "' \"$4\"\n");
    std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
  }

  [[nodiscard]] nlohmann::json document(
      const nlohmann::json& fields = nlohmann::json::object()) const {
    nlohmann::json document = {
        {"format_version", 1},
        {"title", "Three seeds"},
        {"scenario", "tiny"},
        {"axes", nlohmann::json::array({{{"path", "seed"}, {"values", {1, 2, 3}}}})}};
    document.update(fields);
    return document;
  }
  Answer post(const std::string& route, const nlohmann::json& body) {
    return ask(server_->port(), "POST", route, body.dump(), kJson);
  }
  Answer start(const std::string& name, const nlohmann::json& fields = nlohmann::json::object()) {
    return post(kSweepRoute, {{"name", name}, {"document", document(fields)}, {"jobs", 1}});
  }
  Answer post_to(const std::string& name, const std::string& what) {
    return post(std::string(kSweepRoute) + "/" + name + "/" + what, nlohmann::json::object());
  }
  nlohmann::json entry(const std::string& name) {
    const nlohmann::json list = ask(server_->port(), "GET", kSweepRoute).json();
    for (const nlohmann::json& sweep : list.at("sweeps")) {
      if (sweep.at("name") == name) return sweep;
    }
    throw std::runtime_error("no sweep " + name);
  }
  /// Waits until this server no longer flies the sweep.
  nlohmann::json ended(const std::string& name) {
    return wait_for(name, [](const nlohmann::json& sweep) { return sweep.at("here").is_null(); });
  }
  template <typename Condition>
  nlohmann::json wait_for(const std::string& name, Condition condition) {
    for (int i = 0; i < 3000; ++i) {
      nlohmann::json sweep = entry(name);
      if (condition(sweep)) return sweep;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("sweep " + name + " stands still for 30 s");
  }
  void wait_for_calls(std::size_t count) {
    for (int i = 0; i < 3000 && lines("flights").size() < count; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_GE(lines("flights").size(), count);
  }
  [[nodiscard]] std::vector<std::string> lines(const std::string& name) const {
    std::vector<std::string> found;
    if (!std::filesystem::exists(own_.path() / name)) return found;
    std::istringstream text(read_text(own_.path() / name));
    for (std::string line; std::getline(text, line);) found.push_back(line);
    return found;
  }
  void block() { write_text(own_.path() / "block", ""); }
  void unblock() { std::filesystem::remove(own_.path() / "block"); }
  [[nodiscard]] std::filesystem::path sweep_files() const {
    std::filesystem::create_directories(server_->folder() / "scenarios/sweeps");
    return server_->folder() / "scenarios/sweeps";
  }
  [[nodiscard]] std::filesystem::path program() const { return own_.path() / "program"; }

  TemporaryFolder own_;
  std::unique_ptr<TestServer> server_;
};

}  // namespace overfly::testing
