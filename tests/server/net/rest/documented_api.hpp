// A server whose answers are checked against the OpenAPI file that it serves.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "server/files/json_schema.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {

/// OpenAPI keeps its schemas elsewhere than JSON Schema does.
inline nlohmann::json with_defs(nlohmann::json schema, const nlohmann::json& document) {
  std::string text = document.at("components").at("schemas").dump();
  const std::string from = "#/components/schemas/";
  const auto moved = [&](std::string all) {
    for (std::size_t at = 0; (at = all.find(from, at)) != std::string::npos;) {
      all.replace(at, from.size(), "#/$defs/");
    }
    return nlohmann::json::parse(all);
  };
  schema = moved(schema.dump());
  schema["$defs"] = moved(text);
  return schema;
}

class DocumentedApi : public ::testing::Test {
 protected:
  DocumentedApi() : api_(ask(server_.port(), "GET", "/api/v1/openapi.json").json()) {}

  /// Asks, and checks status and body against what the path's entry promises.
  Answer check(const std::string& method,
               const std::string& pattern,
               const std::string& target,
               int status,
               const std::string& body = "",
               const Headers& headers = {}) {
    const Answer answer = ask(server_.port(), method, target, body, headers);
    EXPECT_EQ(answer.status, status) << method << " " << target << ": " << answer.body;
    std::string verb = method;
    std::transform(verb.begin(), verb.end(), verb.begin(), ::tolower);
    const nlohmann::json& operation = api_.at("paths").at(pattern).at(verb);
    const std::string code = std::to_string(status);
    if (!operation.at("responses").contains(code)) {
      ADD_FAILURE() << pattern << " does not document " << code;
      return answer;
    }
    const nlohmann::json& response = operation.at("responses").at(code);
    seen_.insert(verb + " " + pattern);
    if (!response.contains("content")) {
      EXPECT_TRUE(answer.body.empty());
      return answer;
    }
    const std::string type = answer.headers.at("content-type");
    const std::string plain = type.substr(0, type.find(';'));
    if (!response.at("content").contains(plain)) {
      ADD_FAILURE() << pattern << " does not document " << plain;
    } else if (plain == "application/json") {
      const server::JsonSchema schema(
          with_defs(response.at("content").at(plain).at("schema"), api_));
      EXPECT_TRUE(schema.unknown_keywords().empty());
      for (const auto& violation : schema.violations(answer.json())) {
        ADD_FAILURE() << method << " " << target << ": " << violation.text;
      }
    }
    return answer;
  }

  TestServer server_;
  nlohmann::json api_;
  std::set<std::string> seen_;
};

}  // namespace overfly::testing
