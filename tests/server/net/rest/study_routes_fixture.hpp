// A server whose studies are made by a program that the test writes.
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

/// A server with a run whose estimator "perfect" is LOST, and whose studies are made by a program
/// in place of overfly. `program KIND INPUT ... --out FOLDER --progress FILE ...` writes its
/// arguments to `calls` and its process to `made`, reports half of the progress, waits while there
/// is a file `block`, fails while there is a file `fail`, and then writes results with one flight.
class StudyRoutesTest : public ::testing::Test {
 public:
  static constexpr const char* kRoute = "/api/v1/studies";
  static constexpr const char* kFlight = "0123456789abcdef0123";

 protected:
  StudyRoutesTest() {
    net::ServerOptions options;
    options.program = program();
    server_ = std::make_unique<TestServer>(options);
    run_ = server_->fly("tiny");
    const std::filesystem::path run = server_->folder() / "runs" / run_;
    nlohmann::json metrics = nlohmann::json::parse(read_text(run / "metrics.json"));
    metrics["estimators"]["perfect"]["outcome"] = "LOST";
    metrics["estimators"]["perfect"]["outcome_time_s"] = 1.0;
    write_text(run / "metrics.json", metrics.dump());
    write_program(run);
  }

  void write_program(const std::filesystem::path& run) {
    const std::string own = own_.path().string();
    std::string text =
        R"(#!/bin/sh
set -e
echo "$*" >> 'OWN/calls'
echo $$ >> 'OWN/made'
kind=$1
while [ $# -gt 0 ]; do
  case "$1" in --out) out=$2;; --progress) progress=$2;; esac
  shift
done
echo '{"share": 0.5, "text": "3 of at most 6 flights"}' > "$progress"
if [ -e 'OWN/block' ]; then exec sleep 60; fi
if [ -e 'OWN/fail' ]; then echo "warning: slow"; echo "error: the disk is full"; exit 1; fi
mkdir -p "$out/runs"
[ -e "$out/runs/FLIGHT" ] || cp -r 'RUN' "$out/runs/FLIGHT"
echo '{"scenario": "/secret/place", "instants": [{"t_s": 1, "risk_10_s": 0.5, "features": {}}],
  "map": {"rows": 1, "risk_10_s": [1]}, "flights": [{"run": "runs/FLIGHT", "margin": -0.5}]}' > "$out/result"
case $kind in
  explain) mv "$out/result" "$out/explanation.json"; echo '<h1>Why</h1>' > "$out/explanation.html";;
  predict) mv "$out/result" "$out/predict.json"; echo '<h1>Risk</h1>' > "$out/predict.html";;
  hunt) mv "$out/result" "$out/hunt.json"; echo '{"seed": 7}' > "$out/worst.json";;
esac
)";
    for (const auto& [mark, value] : {std::pair<std::string, std::string>{"OWN", own},
                                      {"RUN", run.string()},
                                      {"FLIGHT", kFlight}}) {
      for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;) {
        text.replace(at, mark.size(), value);
        at += value.size();
      }
    }
    write_text(program(), text);
    std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
  }

  Answer post(const std::string& route, const nlohmann::json& body = nlohmann::json::object()) {
    return ask(server_->port(), "POST", route, body.dump(), kJson);
  }
  Answer get(const std::string& route) { return ask(server_->port(), "GET", route); }
  Answer start(const nlohmann::json& request) { return post(kRoute, request); }
  /// @return its name
  std::string started(const nlohmann::json& request) {
    const Answer answer = start(request);
    if (answer.status != 201) throw std::runtime_error(answer.body);
    return answer.json().at("name").get<std::string>();
  }
  [[nodiscard]] nlohmann::json explain(
      const nlohmann::json& fields = nlohmann::json::object()) const {
    nlohmann::json request = {{"kind", "explain"}, {"run", run_}};
    request.update(fields);
    return request;
  }
  [[nodiscard]] static nlohmann::json hunt(
      const nlohmann::json& fields = nlohmann::json::object()) {
    nlohmann::json request = {
        {"kind", "hunt"},
        {"scenario", "tiny"},
        {"axes",
         nlohmann::json::array(
             {{{"path", "flight.course.height_agl_m"}, {"from", 50}, {"to", 80}}})}};
    request.update(fields);
    return request;
  }
  Answer act(const std::string& name, const std::string& what) {
    return post(std::string(kRoute) + "/" + name + "/" + what);
  }
  nlohmann::json shown(const std::string& name) {
    return get(std::string(kRoute) + "/" + name).json();
  }
  nlohmann::json entry(const std::string& name) { return shown(name).at("study"); }
  /// Waits until the study is in a state. @return its entry
  nlohmann::json wait_for(const std::string& name, const std::string& state) {
    nlohmann::json last;
    for (int i = 0; i < 3000; ++i) {
      last = entry(name);
      if (last.at("state") == state) return last;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("study " + name + " is not " + state + " after 30 s: " + last.dump());
  }
  void wait_for_processes(std::size_t count) {
    for (int i = 0; i < 3000 && lines("made").size() < count; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_GE(lines("made").size(), count);
  }
  [[nodiscard]] std::vector<std::string> lines(const std::string& name) const {
    std::vector<std::string> found;
    if (!std::filesystem::exists(own_.path() / name)) return found;
    std::istringstream text(read_text(own_.path() / name));
    for (std::string line; std::getline(text, line);) found.push_back(line);
    return found;
  }
  void put(const std::string& name) { write_text(own_.path() / name, ""); }
  void take_away(const std::string& name) { std::filesystem::remove(own_.path() / name); }
  [[nodiscard]] std::filesystem::path folder(const std::string& name) const {
    return server_->folder() / "studies" / name;
  }
  [[nodiscard]] std::filesystem::path program() const { return own_.path() / "program"; }

  TemporaryFolder own_;
  std::unique_ptr<TestServer> server_;
  std::string run_;  ///< whose estimator was lost
};

}  // namespace overfly::testing
