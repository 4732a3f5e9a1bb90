// Downloads from a server on the loopback that fails in the ways services do.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>

#include "terrain/download.hpp"
#include "terrain/download/http_get.hpp"
#include "tests/terrain/download/download_fixture.hpp"

namespace overfly::terrain {
namespace {

using testing::answer_rightly;
using testing::Counter;
using testing::expect_right_places;
using testing::HttpAnswer;
using testing::HttpRequest;
using testing::LocalHttpServer;
using testing::words;

class DownloadTrouble : public testing::DownloadFixture {};

TEST_F(DownloadTrouble, RepeatsWhatMayPass) {
  // Every address fails once, each in one of the ways services have.
  Counter count;
  std::atomic<int> kind{0};
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (count(request) > 1 || request.path.find("exportImage") == std::string::npos) {
      return answer_rightly(request);
    }
    switch (kind++ % 5) {
      case 0:
        return words(503, "text/html", "<html><title>busy</title></html>");
      case 1:
        return words(200, "application/json", R"({"error":{"code":500,"message":"Error"}})");
      case 2:
        return words(200, "text/html", "<html><title>Sorry</title></html>");
      case 3: {
        HttpAnswer cut = answer_rightly(request);
        cut.cut_after = cut.body.size() / 2;
        return cut;
      }
      default: {
        HttpAnswer cut = answer_rightly(request);  // a cut that the length does not betray
        cut.body.resize(cut.body.size() / 2);
        return cut;
      }
    }
  });
  const auto report = download_world(options_for(server));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->repeated, 5);
  expect_right_places(report->manifest);
}

TEST_F(DownloadTrouble, WaitsAsLongAsTheServiceAsks) {
  Counter count;
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (request.query.contains("bbox") && count(request) == 1) {
      HttpAnswer busy = words(429, "text/plain", "slow down");
      busy.headers.emplace_back("Retry-After: 1");
      return busy;
    }
    return answer_rightly(request);
  });
  DownloadOptions options = options_for(server);
  options.elevation_source = kNoSource;
  options.ground_height_m = 200.0;
  options.size_m = 200.0;
  const auto start = std::chrono::steady_clock::now();
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->repeated, 1);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(990));
}

TEST_F(DownloadTrouble, GivesUpWhereTheServiceAsksForMoreThanTheLimit) {
  const std::string message = failure([](const HttpRequest& request) {
    if (!request.query.contains("bbox")) return answer_rightly(request);
    HttpAnswer busy = words(503, "text/plain", "maintenance");
    busy.headers.emplace_back("Retry-After: 7200");
    return busy;
  });
  EXPECT_NE(message.find("requests a wait of 7200 s, limit 300 s"), std::string::npos) << message;
}

TEST_F(DownloadTrouble, ReadsARetryDate) {
  EXPECT_EQ(download::retry_after_s("120", 0), 120.0);
  // RFC 9110's example date is 784111777 s after the epoch.
  EXPECT_EQ(download::retry_after_s("Sun, 06 Nov 1994 08:49:37 GMT", 784111777 - 30), 30.0);
  EXPECT_FALSE(download::retry_after_s("soon", 0));
}

TEST_F(DownloadTrouble, SaysWhatIsWrongWithAnAnswer) {
  struct Case {
    const char* expected;
    LocalHttpServer::Handler image;
  };
  const auto changed = [](const HttpRequest& request, const char* field, const std::string& value) {
    HttpRequest other = request;
    other.query[field] = value;
    return testing::export_image(other);
  };
  const Case cases[] = {
      {"code 400, \"Invalid bbox\" (attempt 2 of 2)",
       [](const HttpRequest&) {
         return words(
             200, "application/json", R"({"error":{"code":400,"message":"Invalid bbox"}})");
       }},
      {"the answer is empty (attempt 2 of 2)",
       [](const HttpRequest&) { return words(200, "image/tiff", ""); }},
      {"HTTP status 403", [](const HttpRequest&) { return words(403, "text/plain", "no"); }},
      {"HTTP status 404", [](const HttpRequest&) { return words(404, "text/plain", "no"); }},
      {"the service answered with text: Sorry",
       [](const HttpRequest&) {
         return words(200, "text/html", "<html><title>Sorry</title></html>");
       }},
      {"requested 300 x 300",
       [&](const HttpRequest& request) { return changed(request, "size", "256,256"); }},
      {"has the coordinate reference system",
       [&](const HttpRequest& request) { return changed(request, "imageSR", "26917"); }},
      {"has another place",
       [&](const HttpRequest& request) {
         return changed(request, "bbox", "583000,4356000,583300,4356300");
       }},
      {"requested 8 bit",
       [&](const HttpRequest& request) { return changed(request, "pixelType", "F32"); }},
      {"not a readable image",
       [](const HttpRequest&) { return words(200, "image/tiff", "II*\1garbage"); }},
  };
  for (const Case& wrong : cases) {
    const std::string message = failure([&](const HttpRequest& request) {
      return request.path == "/naip/ImageServer/exportImage" ? wrong.image(request)
                                                             : answer_rightly(request);
    });
    EXPECT_NE(message.find(wrong.expected), std::string::npos) << message;
    EXPECT_NE(message.find("/naip/ImageServer/exportImage?bbox="), std::string::npos) << message;
    std::filesystem::remove_all(folder() / "world");
  }
}

TEST_F(DownloadTrouble, GoesOnWhereItStopped) {
  std::atomic<int> images{0};
  std::atomic<bool> broken{true};
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (!request.query.contains("bbox")) return answer_rightly(request);
    if (broken.load() && ++images > 3) return words(500, "text/plain", "down");
    return answer_rightly(request);
  });
  DownloadOptions options = options_for(server);
  options.attempts = 1;
  options.parallel = 1;
  ASSERT_FALSE(download_world(options));
  // One of the three chunks is damaged on the disk meanwhile, and a part of one lies about.
  const std::filesystem::path chunks = options.folder / "chunks";
  ASSERT_TRUE(std::filesystem::exists(chunks / "imagery_0_0.tif"));
  std::filesystem::resize_file(chunks / "imagery_0_0.tif", 5000);
  std::ofstream(chunks / "imagery_300_300.tif.part") << "half";
  broken.store(false);
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->reused, 2);
  EXPECT_EQ(report->fetched, 3);
  expect_right_places(report->manifest);
  // Asked again, there is nothing left to do.
  const int before = server.requests();
  ASSERT_TRUE(download_world(options));
  EXPECT_EQ(server.requests() - before, 2) << "only the services' limits are asked";
}

TEST_F(DownloadTrouble, IsNotResumedByLimitsThatAreOnlyAssumed) {
  std::atomic<bool> broken{false};
  std::atomic<bool> images{false};
  const LocalHttpServer server([&](const HttpRequest& request) {
    const bool image = request.query.contains("bbox");
    if (image ? !images.load() : broken.load()) return words(500, "text/plain", "down");
    return answer_rightly(request);
  });
  DownloadOptions options = options_for(server);
  options.attempts = 1;
  ASSERT_FALSE(download_world(options));
  ASSERT_TRUE(std::filesystem::exists(options.folder / "download.json"));
  broken.store(true);
  images.store(true);
  const auto refused = download_world(options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("by which this download was begun, are not known now"),
            std::string::npos)
      << refused.error().message;
  broken.store(false);
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  expect_right_places(report->manifest);
}

TEST_F(DownloadTrouble, ReportsADamagedRecordAsSuch) {
  const LocalHttpServer server(answer_rightly);
  const DownloadOptions options = options_for(server);
  std::filesystem::create_directories(options.folder);
  const std::filesystem::path record = options.folder / "download.json";
  std::ofstream(record) << R"({"format_version": 1, "lay)";
  const auto refused = download_world(options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(record.string()), std::string::npos);
  EXPECT_EQ(refused.error().message.find("other options"), std::string::npos)
      << refused.error().message;
  std::filesystem::remove(record);
  EXPECT_TRUE(download_world(options));
  EXPECT_FALSE(std::filesystem::exists(record.string() + ".part"));
}

TEST_F(DownloadTrouble, GoesOnAfterItWasKilled) {
  // Forked before the server starts its threads, one of which might hold a lock just then; the
  // server's address follows through a pipe.
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    ::close(pipe[1]);
    std::array<char, 100> address{};
    if (::read(pipe[0], address.data(), address.size() - 1) > 0) {
      DownloadOptions options = options_at(address.data());
      options.parallel = 1;
      (void)download_world(options);
    }
    _exit(0);
  }
  ASSERT_GT(child, 0);
  std::atomic<int> images{0};
  std::atomic<bool> held{true};
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (!request.query.contains("bbox")) return answer_rightly(request);
    // The fourth image is on its way when the kill comes; 20 s end a test that went wrong.
    if (++images == 4) {
      for (int i = 0; i < 2000 && held.load(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    return answer_rightly(request);
  });
  DownloadOptions options = options_for(server);
  options.parallel = 1;
  const std::string address = server.address();
  ASSERT_EQ(::write(pipe[1], address.data(), address.size()), static_cast<ssize_t>(address.size()));
  ::close(pipe[0]);
  ::close(pipe[1]);
  for (int i = 0; i < 2000 && images.load() < 4; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(kill(child, SIGKILL), 0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it had ended before";
  held.store(false);
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->reused, 3);
  EXPECT_EQ(report->fetched, 2);
  expect_right_places(report->manifest);
}

TEST_F(DownloadTrouble, WaitsLongerAfterEachFailure) {
  std::mutex mutex;
  std::vector<std::chrono::steady_clock::time_point> asked;
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (!request.query.contains("bbox")) return answer_rightly(request);
    const std::lock_guard lock(mutex);
    asked.push_back(std::chrono::steady_clock::now());
    return words(503, "text/plain", "busy");
  });
  DownloadOptions options = options_for(server);
  options.size_m = 200.0;
  options.parallel = 1;
  options.attempts = 4;
  options.first_wait_s = 0.04;
  EXPECT_FALSE(download_world(options));
  ASSERT_EQ(asked.size(), 4U);
  for (std::size_t i = 1; i < asked.size(); ++i) {
    // 40, 80, 160 ms, each times 0.5 at least.
    EXPECT_GE(asked[i] - asked[i - 1], std::chrono::milliseconds(10 << i)) << i;
  }
}

TEST_F(DownloadTrouble, TellsWhatAServiceSaysToTooLargeARequest) {
  // It announces 300 px and refuses more than 200.
  const LocalHttpServer server([](const HttpRequest& request) {
    int width = 0;
    const auto size = request.query.find("size");
    if (size != request.query.end()) width = std::stoi(size->second);
    if (width <= 200) return answer_rightly(request);
    return words(
        200,
        "application/json",
        R"({"error":{"code":400,"message":"The requested image exceeds the size limit."}})");
  });
  DownloadOptions options = options_for(server);
  options.attempts = 2;
  const auto refused = download_world(options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("The requested image exceeds the size limit."),
            std::string::npos)
      << refused.error().message;
  std::filesystem::remove_all(options.folder);
  options.chunk_px = 200;
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  expect_right_places(report->manifest);
}

TEST_F(DownloadTrouble, StopsWhenToldTo) {
  const LocalHttpServer server([](const HttpRequest& request) {
    if (request.query.contains("bbox")) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return answer_rightly(request);
  });
  int calls = 0;
  const auto report =
      download_world(options_for(server), [&](double, const std::string&) { return ++calls < 2; });
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::terrain
