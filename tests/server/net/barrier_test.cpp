// What handlers throw, memory that runs out and threads that do not start end a request or a
// connection, never the server.
#include "core/barrier.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <boost/asio/post.hpp>
#include <future>
#include <stdexcept>

#include "server/net/listener.hpp"
#include "server/net/loop_threads.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"
#include "tests/support/allocation_failure.hpp"

namespace overfly::net {
namespace {

using overfly::testing::AllocationFailure;
using overfly::testing::Answer;
using overfly::testing::ask;
using overfly::testing::TestServer;
using ::testing::HasSubstr;

struct Log {
  std::mutex mutex;
  std::string text;
  void add(const std::string& line) {
    const std::lock_guard lock(mutex);
    text += line + "\n";
  }
  std::string all() {
    const std::lock_guard lock(mutex);
    return text;
  }
};

void throw_as_asked(const std::string& kind) {
  if (kind == "text") throw std::runtime_error("the handler's reason");
  if (kind == "memory") throw std::bad_alloc();
  if (kind == "number") throw 7;
}

/// The connections of a server over routes of this test's own.
class ThrowingServer {
 public:
  ThrowingServer() {
    ServerOptions options;
    options.port = 0;
    options.log = [this](const std::string&, const std::string& text) { log.add(text); };
    context_ = std::make_shared<ServerContext>(options, base_.runs(), base_.views());
    context_->offload = [this](std::function<void()> work) {
      boost::asio::post(workers.loop(), std::move(work));
    };
    add_routes();
    const auto bound = listen(&connections.loop(), context_);
    if (!bound) throw std::runtime_error(bound.error().message);
    port = *bound;
    if (!workers.start(1) || !connections.start(1)) throw std::runtime_error("no threads");
  }
  ~ThrowingServer() {
    (void)context_->sessions.close_all(std::chrono::seconds(2));
    context_->gate.close();
  }

  Log log;
  LoopThreads workers{[this](const std::string& what) { log.add(what); }};
  LoopThreads connections{[this](const std::string& what) { log.add(what); }};
  std::uint16_t port = 0;

 private:
  void add_routes() {
    const auto throwing = [](const RouteCall& call, const Respond&) {
      throw_as_asked(call.path.at("kind"));
    };
    const auto late = [](const RouteCall&, const Respond& respond) {
      HttpResponse response;
      response.body = "answered";
      respond(response);
      throw std::runtime_error("after the answer");
    };
    const auto well = [](const RouteCall&, const Respond& respond) {
      HttpResponse response;
      response.body = std::string(1000, 'w');
      respond(response);
    };
    context_->router.add("GET", "/api/v1/throws/{kind}", throwing);
    context_->router.add("GET", "/api/v1/late", late);
    context_->router.add("GET", "/api/v1/well", well);
  }

  TestServer base_;
  std::shared_ptr<ServerContext> context_;
};

TEST(Barrier, TellsWhatEscapes) {
  std::string reported;
  const auto report = [&](const char* what) { reported = what; };
  EXPECT_TRUE(contained([] {}, report));
  EXPECT_EQ(reported, "");
  EXPECT_FALSE(contained([] { throw std::runtime_error("reason"); }, report));
  EXPECT_EQ(reported, "reason");
  EXPECT_FALSE(contained([] { throw 7; }, [](const char*) { throw 8; }));
}

TEST(Barrier, AHandlerThatThrowsIsAnsweredWith500AndTheReasonIsLogged) {
  ThrowingServer server;
  for (const char* kind : {"text", "memory", "number"}) {
    const Answer answer = ask(server.port, "GET", std::string("/api/v1/throws/") + kind);
    EXPECT_EQ(answer.status, 500) << kind;
    EXPECT_EQ(answer.json().at("error").at("code"), "internal");
    EXPECT_EQ(answer.body.find("handler's reason"), std::string::npos);
    EXPECT_THAT(server.log.all(), HasSubstr(std::string("GET /api/v1/throws/") + kind));
  }
  EXPECT_THAT(server.log.all(), HasSubstr("the handler's reason"));
  EXPECT_EQ(ask(server.port, "GET", "/api/v1/late").body, "answered");
  EXPECT_EQ(ask(server.port, "GET", "/api/v1/well").status, 200);
}

TEST(Barrier, AThreadOutlivesATaskThatThrows) {
  Log log;
  LoopThreads threads([&](const std::string& what) { log.add(what); });
  ASSERT_TRUE(threads.start(1));
  boost::asio::post(threads.loop(), [] { throw std::runtime_error("the task's reason"); });
  std::promise<void> next;
  boost::asio::post(threads.loop(), [&] { next.set_value(); });
  next.get_future().wait();
  EXPECT_THAT(log.all(), HasSubstr("the task's reason"));
}

/// In a child process whose user may have no process more. @return its exit code: 0 = as it must be
int start_threads_beyond_the_limit() {
  const rlimit none{0, 0};
  if (::geteuid() == 0 && ::setresuid(65534, 65534, 65534) != 0) return 2;
  if (::setrlimit(RLIMIT_NPROC, &none) != 0) return 3;
  LoopThreads threads([](const std::string&) {});
  const Status started = threads.start(3);
  if (started) return 4;
  return started.error().message.find("0 of 3 server threads") != std::string::npos ? 0 : 5;
}

TEST(Barrier, AThreadThatCannotStartIsAnError) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(::_exit(start_threads_beyond_the_limit()), ::testing::ExitedWithCode(0), "");
}

/// Lets every allocation of the server's two threads fail in its turn.
class MemoryTest : public ::testing::Test {
 protected:
  MemoryTest() {
    for (LoopThreads* threads : {&server_.connections, &server_.workers}) {
      std::promise<void> marked;
      boost::asio::post(threads->loop(), [&] {
        AllocationFailure::may_fail_here();
        marked.set_value();
      });
      marked.get_future().wait();
    }
  }
  ~MemoryTest() override { AllocationFailure::disarm(); }
  /// @return true while there was such an allocation
  template <typename Client>
  bool with_failure_at(int allocation, Client client) {
    AllocationFailure::arm(allocation);
    client();
    return AllocationFailure::disarm();
  }
  ThrowingServer server_;
};

TEST_F(MemoryTest, ThatRunsOutEndsOneRequest) {
  int failures = 0;
  int answers = 0;
  for (int i = 0; i < 400; ++i) {
    const bool failed = with_failure_at(
        i, [&] { answers += ask(server_.port, "GET", "/api/v1/well").status == 200 ? 1 : 0; });
    failures += failed ? 1 : 0;
    ASSERT_EQ(ask(server_.port, "GET", "/api/v1/well").status, 200) << "after allocation " << i;
    if (!failed) break;
  }
  EXPECT_GT(failures, 20);
  EXPECT_GT(answers, 0);
}

}  // namespace
}  // namespace overfly::net
