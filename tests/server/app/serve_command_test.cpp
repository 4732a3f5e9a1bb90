// overfly serve as a person starts it: what it prints, its token, and how it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>

#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

/// The line that a server prints; it is stopped then.
std::string printed_by_serve(const std::vector<std::string>& options, std::string* err = nullptr) {
  const TemporaryFolder output;
  std::vector<std::string> arguments = {
      "serve", "--port", "0", "--runs", (output.path() / "runs").string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  RunningProgram program(arguments, output.path());
  while (program.running() && program.out().find('\n') == std::string::npos) {
    ::poll(nullptr, 0, 5);
  }
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(), 0) << program.err();
  if (err != nullptr) *err = program.err();
  return program.out();
}

/// What a server says that does not start because of its options.
std::string refused_by_serve(const std::vector<std::string>& options) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {
      "serve", "--port", "0", "--runs", (folder.path() / "runs").string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = overfly_program(arguments);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out << outcome.err;
  return outcome.err;
}

TEST(ServeCommand, PrintsItsAddressAndStopsOnASignal) {
  EXPECT_THAT(printed_by_serve({}),
              MatchesRegex("Overfly is at http://127.0.0.1:[0-9]+/\\?token=[A-Za-z0-9_-]{32}\n"));
  EXPECT_THAT(refused_by_serve({"--web", "/no/such/folder"}), HasSubstr("/no/such/folder"));
}

TEST(ServeCommand, KeepsItsTokenInAFile) {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  const std::string made = printed_by_serve({"--token-file", path("token")});
  const std::string token = read_text(path("token"));
  EXPECT_THAT(token, MatchesRegex("[A-Za-z0-9_-]{32}\n"));
  EXPECT_THAT(made, HasSubstr("/?token=" + token));
  const auto mode = std::filesystem::status(path("token")).permissions();
  EXPECT_EQ(mode & std::filesystem::perms(077), std::filesystem::perms::none);

  write_text(path("ours"), "a-token-of-our-own.0123456789");
  std::filesystem::permissions(path("ours"), std::filesystem::perms(0644));
  std::string err;
  EXPECT_THAT(printed_by_serve({"--token-file", path("ours")}, &err),
              HasSubstr("/?token=a-token-of-our-own.0123456789\n"));
  EXPECT_THAT(err, HasSubstr("can be read by others"));
  EXPECT_THAT(err, Not(HasSubstr("a-token-of-our-own")));
}

TEST(ServeCommand, PrintsTheAddressOfViewersToo) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "viewers").string();
  const std::string printed = printed_by_serve({"--viewer-token-file", file});
  EXPECT_THAT(printed, MatchesRegex("Overfly is at [^\n]*\nFor looking only: [^\n]*\n"));
  EXPECT_THAT(printed, HasSubstr("/?token=" + read_text(file)));
  EXPECT_THAT(refused_by_serve({"--token-file", file, "--viewer-token-file", file}),
              HasSubstr("must differ"));
  EXPECT_THAT(refused_by_serve({"--no-token", "--viewer-token-file", file}),
              HasSubstr("--viewer-token-file"));
}

TEST(ServeCommand, RefusesTokenFilesThatHoldNone) {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  write_text(path("short"), "secret\n");
  write_text(path("two"), std::string(30, 'a') + "\n" + std::string(30, 'b') + "\n");
  write_text(path("long"), std::string(5000, 'a'));
  ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
  for (const std::string& file : {path("short"),
                                  path("two"),
                                  path("long"),
                                  path("fifo"),
                                  path("."),
                                  std::string("/dev/null")}) {
    const std::string err = refused_by_serve({"--token-file", file});
    EXPECT_THAT(err, HasSubstr(file));
    EXPECT_THAT(err, Not(HasSubstr("aaaa")));
  }
}

TEST(ServeCommand, GoesWithoutATokenOnLoopbackOnly) {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  EXPECT_THAT(printed_by_serve({"--no-token"}),
              MatchesRegex("Overfly is at http://127.0.0.1:[0-9]+/\n"));
  EXPECT_THAT(printed_by_serve({"--no-token", "--address", "localhost"}), HasSubstr("localhost"));
  EXPECT_THAT(refused_by_serve({"--no-token", "--address", "0.0.0.0"}), HasSubstr("token"));
  EXPECT_THAT(refused_by_serve({"--no-token", "--address", "::"}), HasSubstr("token"));
  EXPECT_THAT(refused_by_serve({"--no-token", "--token-file", path("token")}),
              HasSubstr("--token-file"));
  EXPECT_THAT(printed_by_serve({"--address", "0.0.0.0"}), HasSubstr("http://127.0.0.1:"));
}

}  // namespace
}  // namespace overfly::testing
