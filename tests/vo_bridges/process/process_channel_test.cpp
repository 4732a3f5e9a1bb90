// What one frame may bring: all that the protocol allows, and not without end.
#include "vo_bridges/process/link/channel.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>

#include <array>
#include <thread>

namespace overfly::process {
namespace {

using ::testing::HasSubstr;

/// A camera whose debug image alone has more than 64 MiB.
constexpr std::size_t kPixels = 24'000'000;
constexpr std::size_t kImageBytes = 24 + 3 * kPixels;

class ProcessChannel : public ::testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    channel_.emplace(FileDescriptor(ends[0]));
    other_ = FileDescriptor(ends[1]);
    channel_->begin_frame(kPixels);
  }

  /// Sends a message; gives up when nobody reads on.
  void send(MessageType type, std::size_t payload_bytes) {
    std::string bytes = header_of(type, payload_bytes);
    bytes.resize(bytes.size() + payload_bytes);
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t n =
          ::send(other_.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return;
      sent += static_cast<std::size_t>(n);
    }
  }

  Result<std::optional<Message>> next() {
    return channel_->next(Clock::now() + std::chrono::seconds(20));
  }

  std::optional<Channel> channel_;
  FileDescriptor other_;
};

TEST_F(ProcessChannel, TakesTheLargestDebugImageOfALargeCamera) {
  std::thread estimator([this] {
    send(MessageType::kDebugImage, kImageBytes);
    send(MessageType::kAnswer, 88);
  });
  const Result<std::optional<Message>> image = next();
  EXPECT_TRUE(image.ok()) << image.error().message;
  if (image.ok() && *image) {
    EXPECT_EQ((*image)->payload.size(), kImageBytes);
    const Result<std::optional<Message>> answer = next();
    EXPECT_TRUE(answer.ok() && *answer && (*answer)->type == MessageType::kAnswer);
  }
  channel_.reset();
  estimator.join();
}

TEST_F(ProcessChannel, TakesNoDebugImagesWithoutEnd) {
  std::thread estimator([this] {
    for (int i = 0; i < 2; ++i) send(MessageType::kDebugImage, kImageBytes);
  });
  EXPECT_TRUE(next().ok());
  const Result<std::optional<Message>> second = next();
  EXPECT_FALSE(second.ok());
  if (!second.ok()) {
    EXPECT_THAT(second.error().message, HasSubstr("the estimator floods: 2 messages, 137 MiB"));
  }
  channel_.reset();
  estimator.join();
}

}  // namespace
}  // namespace overfly::process
