#include "vo_bridges/process/link/channel.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace overfly::process {

namespace {

constexpr std::size_t kFrameMessageLimit = 10'000;
/// Maximum size of all messages for one frame, in addition to a debug image of maximum size.
constexpr std::size_t kFrameBytesLimit = std::size_t{64} << 20U;
constexpr std::size_t kReadBytes = 65536;

Error broken(const std::string& what) { return {ErrorCode::kInternal, what}; }

/// Sends bytes and a descriptor with them; otherwise like send(2).
ssize_t send_part(int socket, const char* bytes, std::size_t count, int attached) {
  iovec part{const_cast<char*>(bytes), count};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  if (attached >= 0) {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* const head = CMSG_FIRSTHDR(&message);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(head), &attached, sizeof(int));
  }
  return ::sendmsg(socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace

void Channel::enqueue(std::string bytes,
                      std::shared_ptr<const Image> pixels,
                      FileDescriptor attached) {
  out_.push_back({std::move(bytes), std::move(pixels), std::move(attached)});
}

void Channel::begin_frame(std::size_t pixels) {
  frame_pixels_ = pixels;
  begin_counts();
}

void Channel::begin_counts() {
  frame_messages_ = 0;
  frame_bytes_ = 0;
}

Status Channel::send_some() {
  while (!out_.empty()) {
    Chunk& chunk = out_.front();
    const bool in_head = sent_of_first_ < chunk.bytes.size();
    const std::size_t begin = in_head ? sent_of_first_ : sent_of_first_ - chunk.bytes.size();
    const char* const bytes =
        in_head ? chunk.bytes.data() : reinterpret_cast<const char*>(chunk.pixels->data.data());
    const std::size_t count = (in_head ? chunk.bytes.size() : chunk.pixels->data.size()) - begin;
    const ssize_t sent = send_part(socket_.get(), bytes + begin, count, chunk.attached.get());
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {};
    // A closed connection may still hold the estimator's last messages; the reader detects its end.
    if (sent < 0 && (errno == EPIPE || errno == ECONNRESET)) {
      out_.clear();
      sent_of_first_ = 0;
      return {};
    }
    if (sent < 0) return broken("sending: " + std::generic_category().message(errno));
    chunk.attached.close();
    sent_of_first_ += static_cast<std::size_t>(sent);
    const std::size_t all = chunk.bytes.size() + (chunk.pixels ? chunk.pixels->data.size() : 0);
    if (sent_of_first_ == all) {
      out_.pop_front();
      sent_of_first_ = 0;
    }
  }
  return {};
}

Status Channel::receive_some() {
  if (taken_ > 0) {
    in_.erase(0, taken_);
    taken_ = 0;
  }
  const std::size_t before = in_.size();
  in_.resize(before + kReadBytes);
  const ssize_t got = ::recv(socket_.get(), in_.data() + before, kReadBytes, MSG_DONTWAIT);
  const int failure = errno;
  in_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got > 0) return {};
  if (got == 0 || failure == ECONNRESET) {
    closed_ = true;
    return broken("the estimator closed the connection");
  }
  if (failure == EAGAIN || failure == EWOULDBLOCK || failure == EINTR) return {};
  return broken("receiving: " + std::generic_category().message(failure));
}

Result<MessageType> Channel::check_header(std::string_view header, std::size_t* length) {
  if (!header.starts_with(kMagic)) {
    return broken("the estimator sent " + shown(std::string_view(in_).substr(taken_)) +
                  " where a message must begin with \"OVVO\"");
  }
  ByteReader reader(header.substr(kMagic.size()));
  const std::uint16_t version = reader.u16();
  if (version != kProtocolVersion) {
    return broken("the estimator uses protocol version " + std::to_string(version) + ": must be " +
                  std::to_string(kProtocolVersion));
  }
  const auto type = static_cast<MessageType>(reader.u16());
  *length = reader.u32();
  const std::optional<std::size_t> limit = payload_limit_bytes(type, frame_pixels_);
  if (!limit)
    return broken("the estimator sent " + name_of(type) + ", which an estimator must not send");
  if (*length > *limit) {
    return broken("the estimator announced " + name_of(type) + " of " + std::to_string(*length) +
                  " bytes: must be at most " + std::to_string(*limit));
  }
  return type;
}

Result<std::optional<Message>> Channel::take_message() {
  const std::string_view waiting = std::string_view(in_).substr(taken_);
  // Check the magic as far as it was received: another program may send a few bytes and then wait.
  const std::string_view begin = waiting.substr(0, std::min(waiting.size(), kMagic.size()));
  if (!kMagic.starts_with(begin)) {
    std::size_t ignored = 0;
    return check_header(waiting, &ignored).error();
  }
  if (waiting.size() < kHeaderBytes) return std::optional<Message>{};
  std::size_t length = 0;
  const Result<MessageType> type = check_header(waiting.substr(0, kHeaderBytes), &length);
  if (!type) return type.error();
  if (waiting.size() < kHeaderBytes + length) return std::optional<Message>{};
  ++frame_messages_;
  frame_bytes_ += kHeaderBytes + length;
  const std::size_t bytes_limit =
      kFrameBytesLimit + payload_limit_bytes(MessageType::kDebugImage, frame_pixels_).value_or(0);
  if (frame_messages_ > kFrameMessageLimit || frame_bytes_ > bytes_limit) {
    return broken("the estimator floods: " + std::to_string(frame_messages_) + " messages, " +
                  std::to_string(frame_bytes_ >> 20U) + " MiB for one frame, the last " +
                  name_of(*type) + " " + shown(waiting.substr(kHeaderBytes, length)));
  }
  taken_ += kHeaderBytes + length;
  return std::optional<Message>(Message{*type, std::string(waiting.substr(kHeaderBytes, length))});
}

Result<std::optional<Message>> Channel::next(Clock::time_point deadline) {
  for (;;) {
    Result<std::optional<Message>> message = take_message();
    if (!message || *message) return message;
    if (Status status = send_some(); !status) return status.error();
    pollfd socket{socket_.get(), static_cast<short>(POLLIN | (out_.empty() ? 0 : POLLOUT)), 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    const int ready = ::poll(&socket, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready < 0 && errno != EINTR) {
      return broken("waiting: " + std::generic_category().message(errno));
    }
    if (ready > 0 && (socket.revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
      if (Status status = receive_some(); !status) return status.error();
      continue;
    }
    if (Clock::now() >= deadline) return std::optional<Message>{};
  }
}

}  // namespace overfly::process
