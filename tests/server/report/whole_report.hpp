// Whole reports of a small run.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/report/report.hpp"
#include "tests/server/report/markup_reader.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::report::testing {

inline constexpr const char* kTwo =
    R"(estimators=[{"name":"p","type":"perfect"},
                   {"name":"d","type":"drifting","parameters":{"drift":0.02}}])";

/// A run of 2 s in `folder`.
inline void fly(const std::filesystem::path& folder, std::vector<std::string> overrides = {}) {
  overrides.insert(overrides.begin(), kTwo);
  const auto run = run_scenario(server::testing::small_scenario(overrides),
                                server::testing::options_for(folder));
  ASSERT_TRUE(run.ok()) << run.error().message;
}

inline MadeReport made(const std::vector<std::filesystem::path>& runs,
                       const ReportOptions& options = {}) {
  Result<MadeReport> report = make_report(runs, options);
  EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().message);
  return report.ok() ? *report : MadeReport{};
}

inline nlohmann::json data_of(const std::string& html) {
  for (const Element& script : read_markup(html).named("script")) {
    if (script.attribute("id") == "overfly-report") return nlohmann::json::parse(script.text);
  }
  return {};
}

/// Nothing in the page can load or run anything.
inline void expect_self_contained(const std::string& html) {
  const Markup markup = read_markup(html);
  ASSERT_EQ(markup.fault, "");
  EXPECT_EQ(markup.named("script").size(), 1U);  // the data
  for (const Element& element : markup.elements) {
    EXPECT_THAT(std::vector<std::string>({"iframe",
                                          "object",
                                          "embed",
                                          "link",
                                          "base",
                                          "form",
                                          "audio",
                                          "video",
                                          "use",
                                          "foreignObject"}),
                ::testing::Not(::testing::Contains(element.name)));
    for (const auto& [key, value] : element.attributes) {
      EXPECT_NE(key.substr(0, 2), "on") << element.name;
      EXPECT_NE(key, "style");
      if (key != "href" && key != "src") continue;
      EXPECT_TRUE(value.starts_with("#") || value.starts_with("data:image/jpeg;base64,")) << value;
    }
  }
  for (const Element& style : markup.named("style")) {
    EXPECT_THAT(style.text, ::testing::Not(::testing::HasSubstr("url(")));
  }
}

class ReportTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new overfly::testing::TemporaryFolder;
    fly(run_folder());
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::filesystem::path run_folder() { return folder_->path() / "run"; }
  /// A copy of the run, to be changed.
  [[nodiscard]] std::filesystem::path copy(const std::string& name = "copy") const {
    std::filesystem::copy(
        run_folder(), own_.path() / name, std::filesystem::copy_options::recursive);
    return own_.path() / name;
  }
  [[nodiscard]] const std::filesystem::path& own() const { return own_.path(); }

 private:
  inline static overfly::testing::TemporaryFolder* folder_ = nullptr;
  overfly::testing::TemporaryFolder own_;
};

}  // namespace overfly::server::report::testing
