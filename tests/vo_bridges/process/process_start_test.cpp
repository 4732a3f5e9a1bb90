// Estimators that do not start, and options that are refused.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>

#include "tests/support/support.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"

namespace overfly {
namespace {

using ::testing::AllOf;
using testing::ground_frames;
using ::testing::HasSubstr;
using testing::scripted;
using testing::started;

class ProcessStart : public testing::ChildrenTest {};

TEST_F(ProcessStart, AMissingProgramIsNamed) {
  ProcessEstimatorOptions options;
  options.command = {"./no/such/estimator"};
  EXPECT_EQ(start_error(options).code, ErrorCode::kNotFound);
  EXPECT_THAT(start_error(options).message,
              HasSubstr("'./no/such/estimator': there is no such file"));
  options.command = {"no-such-estimator-anywhere"};
  EXPECT_EQ(start_error(options).code, ErrorCode::kNotFound);
  EXPECT_THAT(start_error(options).message, HasSubstr("no such program in $PATH"));
}

TEST_F(ProcessStart, AFileThatCannotBeExecutedIsNamed) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "estimator";
  testing::write_text(file, "#!/no/such/interpreter\n");
  ProcessEstimatorOptions options;
  options.command = {file.string()};
  EXPECT_EQ(start_error(options).code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(start_error(options).message, HasSubstr("chmod +x"));
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  EXPECT_EQ(start_error(options).code, ErrorCode::kNotFound);
  EXPECT_THAT(start_error(options).message, HasSubstr("interpreter"));
  testing::write_text(file, "print('hello')\n");
  EXPECT_THAT(start_error(options).message, HasSubstr("a script starts with #!"));
  options = scripted("good");
  options.working_folder = folder.path() / "absent";
  EXPECT_THAT(start_error(options).message,
              HasSubstr("working_folder = '" + options.working_folder.string()));
}

TEST_F(ProcessStart, AFailureKeepsNoDescriptor) {
  const auto descriptors = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                         std::filesystem::directory_iterator());
  };
  const char* const given = std::getenv("TMPDIR");
  const std::string before = given != nullptr ? given : "";
  ::setenv("TMPDIR", "/proc", 1);  // where nobody can make a folder
  ProcessEstimatorOptions options = scripted("good");
  options.listen = "tcp:127.0.0.1:0";
  EXPECT_THAT(start_error(options).message, HasSubstr("cannot make folder"));
  const auto open = descriptors();
  for (int i = 0; i < 5; ++i) (void)start_error(options);
  EXPECT_EQ(descriptors(), open);
  given != nullptr ? ::setenv("TMPDIR", before.c_str(), 1) : ::unsetenv("TMPDIR");
}

TEST_F(ProcessStart, AChildThatEndsAtOnceIsQuoted) {
  const Error error = start_error(scripted("no_start"));
  EXPECT_EQ(error.code, ErrorCode::kInternal);
  EXPECT_THAT(error.message,
              AllOf(HasSubstr("ended before it sent HELLO"),
                    HasSubstr("exited with code 3"),
                    HasSubstr("ORBvoc.txt: no such file")));
}

TEST_F(ProcessStart, ASlowStartIsCutShort) {
  for (const char* const behaviour : {"slow_start", "silent"}) {
    ProcessEstimatorOptions options = scripted(behaviour);
    options.start_timeout_s = 0.3;
    Error error;
    EXPECT_LT(seconds_of([&] { error = start_error(options); }), 5.0);
    EXPECT_EQ(error.code, ErrorCode::kInternal);
    EXPECT_THAT(error.message, HasSubstr("within 0.3 s")) << behaviour;
  }
}

TEST_F(ProcessStart, ASlowCalibrationIsCutShort) {
  ProcessEstimatorOptions options = scripted("slow_calibration");
  options.start_timeout_s = 2.0;
  const auto estimator = started(options);
  EXPECT_THAT(estimator->prepare(ground_frames(1, 1.0, 1.0, 64, 48)[0]).error().message,
              HasSubstr("was not ready after CALIBRATION"));
}

TEST_F(ProcessStart, AnUnknownParameterEndsTheStart) {
  ProcessEstimatorOptions options = scripted("good");
  options.parameters["nonsense"] = 3.0;
  EXPECT_THAT(start_error(options).message, HasSubstr("error: unknown parameter nonsense"));
}

TEST_F(ProcessStart, GarbageInsteadOfAHelloIsQuoted) {
  EXPECT_THAT(start_error(scripted("web")).message,
              AllOf(HasSubstr("47 45 54 20"), HasSubstr("GET / HTTP"), HasSubstr("OVVO")));
  EXPECT_THAT(start_error(scripted("huge")).message,
              HasSubstr("HELLO of 4294967295 bytes: must be at most 65536"));
  EXPECT_THAT(start_error(scripted("server_message")).message,
              HasSubstr("sent STOP, which an estimator must not send"));
}

TEST_F(ProcessStart, AnotherVersionIsRefused) {
  EXPECT_THAT(start_error(scripted("version_2")).message,
              HasSubstr("uses protocol version 2: must be 1"));
  EXPECT_THAT(start_error(scripted("text_version_9")).message,
              HasSubstr("uses protocol version '9': must be 1"));
}

TEST_F(ProcessStart, BadOptionsAreNamed) {
  const auto error_with = [](const std::function<void(ProcessEstimatorOptions*)>& change) {
    ProcessEstimatorOptions options = scripted("good");
    change(&options);
    const Error error = start_error(options);
    EXPECT_EQ(error.code, ErrorCode::kInvalidArgument);
    return error.message;
  };
  EXPECT_THAT(error_with([](auto* o) { o->command.clear(); }), HasSubstr("command"));
  EXPECT_THAT(error_with([](auto* o) { o->command = {""}; }), HasSubstr("command[0]"));
  EXPECT_THAT(error_with([](auto* o) { o->start_timeout_s = 0.0; }),
              HasSubstr("start_timeout_s = 0"));
  EXPECT_THAT(error_with([](auto* o) { o->answer_timeout_s = 3601.0; }),
              HasSubstr("answer_timeout_s = 3601"));
  EXPECT_THAT(error_with([](auto* o) { o->memory_limit_mb = -1.0; }),
              HasSubstr("memory_limit_mb = -1"));
  EXPECT_THAT(error_with([](auto* o) {
                o->cpus = {testing::first_cpu(), 1000};
              }),
              HasSubstr("cpus[1] = 1000"));
  EXPECT_THAT(error_with([](auto* o) { o->parameters["a b"] = 1.0; }), HasSubstr("'a b'"));
  EXPECT_THAT(error_with([](auto* o) { o->parameters["a"] = std::string("x\ny"); }),
              HasSubstr("parameters.a"));
  EXPECT_THAT(error_with([](auto* o) { o->listen = "udp:there"; }),
              HasSubstr("listen = 'udp:there'"));
  EXPECT_THAT(error_with([](auto* o) { o->listen = "tcp:127.0.0.1:99999"; }),
              HasSubstr("[0, 65535]"));
  EXPECT_THAT(error_with([](auto* o) { o->listen = "unix:" + std::string(120, 'x'); }),
              HasSubstr("1 to 107 bytes"));
  EXPECT_THAT(error_with([](auto* o) {
                o->command.clear();
                o->listen = "tcp:127.0.0.1:0";
              }),
              HasSubstr("port 0"));
}

}  // namespace
}  // namespace overfly
