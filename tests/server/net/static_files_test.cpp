#include "server/net/http/static_files.hpp"

#include <gtest/gtest.h>

#include "server/net/http_answers.hpp"
#include "tests/support/support.hpp"

namespace overfly::net {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;

class StaticFilesTest : public ::testing::Test {
 protected:
  StaticFilesTest() {
    fs::create_directories(root() / "assets");
    write_text(root() / "index.html", "<html>");
    write_text(root() / "assets" / "main-1a2b.js", "code");
    write_text(root() / "with space.txt", "space");
    write_text(root() / ".secret", "hidden");
    write_text(folder_.path() / "outside.txt", "outside");
  }
  [[nodiscard]] fs::path root() const { return folder_.path() / "web"; }
  [[nodiscard]] HttpResponse get(const std::string& target, const std::string& etag = "") const {
    HttpRequest request{"GET", target, {}, ""};
    if (!etag.empty()) request.headers["if-none-match"] = etag;
    return StaticFiles(root()).serve(request);
  }
  static std::string header(const HttpResponse& response, const std::string& name) {
    for (const auto& [key, value] : response.headers) {
      if (key == name) return value;
    }
    return "";
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(StaticFilesTest, ServesFilesWithTheirType) {
  EXPECT_EQ(get("/").body, "<html>");
  EXPECT_EQ(get("/").content_type, "text/html; charset=utf-8");
  EXPECT_EQ(get("/assets/main-1a2b.js").content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/with%20space.txt?v=1").body, "space");
}

TEST_F(StaticFilesTest, LetsHashedFilesBeKeptAndOthersBeAskedFor) {
  EXPECT_NE(header(get("/assets/main-1a2b.js"), "Cache-Control").find("immutable"),
            std::string::npos);
  const std::string etag = header(get("/index.html"), "ETag");
  EXPECT_FALSE(etag.empty());
  EXPECT_EQ(header(get("/index.html"), "Cache-Control"), "no-cache");
  EXPECT_EQ(get("/index.html", etag).status, 304);
  EXPECT_EQ(get("/index.html", "\"other\"").status, 200);
}

TEST_F(StaticFilesTest, AViewersPageSaysSo) {
  const auto as_viewer = [&](const std::string& target, const std::string& etag = "") {
    HttpRequest request{"GET", target, {}, ""};
    request.access = Access::kViewer;
    if (!etag.empty()) request.headers["if-none-match"] = etag;
    return StaticFiles(root()).serve(request);
  };
  EXPECT_EQ(as_viewer("/").body, "<html data-access=\"viewer\">");
  EXPECT_EQ(as_viewer("/runs/abc").body, "<html data-access=\"viewer\">");
  EXPECT_EQ(as_viewer("/assets/main-1a2b.js").body, "code");
  // Nobody keeps the other one's page.
  const std::string ours = header(get("/"), "ETag");
  const std::string theirs = header(as_viewer("/"), "ETag");
  EXPECT_EQ(as_viewer("/", ours).status, 200);
  EXPECT_EQ(get("/", theirs).status, 200);
  EXPECT_EQ(as_viewer("/", theirs).status, 304);
}

/// RFC 9110, 8.6.
TEST_F(StaticFilesTest, AnswersWithoutBodyHaveNoLength) {
  namespace http = boost::beast::http;
  const std::string etag = header(get("/index.html"), "ETag");
  EXPECT_EQ(
      http_answer(get("/index.html", etag), 11, true, false).count(http::field::content_length),
      0U);
  HttpResponse deleted;
  deleted.status = 204;
  EXPECT_EQ(http_answer(deleted, 11, true, false).count(http::field::content_length), 0U);
  EXPECT_EQ(http_answer(get("/index.html"), 11, true, true)[http::field::content_length], "6");
}

TEST_F(StaticFilesTest, GivesTheDashboardForItsOwnAddressesOnly) {
  EXPECT_EQ(get("/runs/abc").body, "<html>");
  EXPECT_EQ(get("/assets/gone.js").status, 404);
}

TEST_F(StaticFilesTest, NeverLeavesItsFolder) {
  std::error_code error;
  fs::create_symlink(root().parent_path() / "outside.txt", root() / "link.txt", error);
  for (const char* target : {"/../outside.txt",
                             "/..%2Foutside.txt",
                             "/%2e%2e/outside.txt",
                             "/assets/../../outside.txt",
                             "/assets/%2e%2e%2f%2e%2e%2foutside.txt",
                             "/..\\outside.txt",
                             "//etc/passwd",
                             "/%2Fetc%2Fpasswd",
                             "/.secret",
                             "/./index.html",
                             "/index.html%00.js",
                             "/link.txt",
                             "/assets"}) {
    EXPECT_FALSE(resolve_below(root(), target)) << target;
    EXPECT_NE(get(target).body, "outside") << target;
    EXPECT_NE(get(target).body, "hidden") << target;
  }
}

TEST_F(StaticFilesTest, RefusesOtherMethods) {
  const HttpResponse response = StaticFiles(root()).serve({"POST", "/index.html", {}, ""});
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(header(response, "Allow"), "GET, HEAD");
}

TEST_F(StaticFilesTest, SaysSoWithoutADashboard) {
  EXPECT_EQ(StaticFiles("").serve({"GET", "/", {}, ""}).status, 404);
}

}  // namespace
}  // namespace overfly::net
