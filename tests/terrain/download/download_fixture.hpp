// Downloads of 600 m in southern Indiana from a server on the loopback.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <string>

#include "terrain/download.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/download/image_service.hpp"
#include "tests/terrain/local_http_server.hpp"

namespace overfly::testing {

/// As the image services do: their description, images of at most 300 px.
[[nodiscard]] HttpAnswer answer_rightly(const HttpRequest& request);

[[nodiscard]] HttpAnswer words(int status, const std::string& type, const std::string& body);

/// Counts how often each address was asked.
class Counter {
 public:
  int operator()(const HttpRequest& request) {
    const std::lock_guard lock(mutex_);
    return ++counts_[request.path +
                     (request.query.contains("bbox") ? request.query.at("bbox") : "")];
  }

 private:
  std::mutex mutex_;
  std::map<std::string, int> counts_;
};

class DownloadFixture : public ::testing::Test {
 protected:
  /// 600 m at 1 m: four requests of imagery, one of elevation.
  [[nodiscard]] terrain::DownloadOptions options_for(const LocalHttpServer& server) const;
  /// @param address  of the server: http://127.0.0.1:PORT
  [[nodiscard]] terrain::DownloadOptions options_at(const std::string& address) const;
  /// The message of a download that must fail.
  [[nodiscard]] std::string failure(const LocalHttpServer::Handler& handler) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// Every texel and height of a downloaded world is that of its place.
void expect_right_places(const std::filesystem::path& manifest);

}  // namespace overfly::testing
