#include "flight/mavlink/link/stream_link.hpp"

#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <utility>

#include "flight/mavlink/link/socket_address.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::size_t kStreamReadBytes = 65536;
constexpr int kReadsAtOnce = 4;
constexpr std::size_t kMaxWaitingBytes = 65536;

/// Bytes in order through one descriptor at a time.
class StreamLink : public ByteLink {
 public:
  StreamLink(const LinkAddress& address, bool read_only, FileDescriptor stream, bool connecting)
      : ByteLink(address, read_only),
        is_socket_(address.kind != LinkKind::kSerial),
        stream_(std::move(stream)),
        connecting_(connecting),
        buffer_(kStreamReadBytes) {}

  void add_to_poll(std::vector<pollfd>& descriptors) const override {
    if (!stream_.open()) return;
    const bool writes = connecting_ || !waiting_.empty();
    descriptors.push_back(
        {stream_.get(), static_cast<short>(writes ? POLLIN | POLLOUT : POLLIN), 0});
  }
  [[nodiscard]] Status exchange(TimePoint now,
                                const Take& take,
                                const Replace& /*replace*/) override {
    if (connecting_) {
      if (Status status = finish_connecting(); !status || connecting_) return status;
    }
    if (Status status = send_waiting(); !status) return status;
    for (int i = 0; i < kReadsAtOnce; ++i) {
      const ssize_t got = ::read(stream_.get(), buffer_.data(), buffer_.size());
      if (got < 0 && errno == EINTR) continue;
      if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {};
      if (got < 0) return system_failure(address(), "receiving", errno);
      if (got == 0) return Error{ErrorCode::kIo, address().text() + ": closed by the other side"};
      heard_ = now;
      take(0, std::span(buffer_).first(static_cast<std::size_t>(got)));
    }
    return {};
  }
  [[nodiscard]] bool connected() const override { return stream_.open() && !connecting_; }

 protected:
  void use(FileDescriptor stream, TimePoint now) {
    stream_ = std::move(stream);
    waiting_.clear();
    heard_ = now;
  }
  [[nodiscard]] bool has_stream() const { return stream_.open(); }
  /// When bytes were received last, or the stream was first used.
  [[nodiscard]] TimePoint heard() const { return heard_; }

 private:
  Status finish_connecting() {
    pollfd ready{stream_.get(), POLLOUT, 0};
    if (::poll(&ready, 1, 0) <= 0) return {};
    int failure = 0;
    socklen_t size = sizeof failure;
    if (::getsockopt(stream_.get(), SOL_SOCKET, SO_ERROR, &failure, &size) != 0) failure = errno;
    if (failure != 0) return system_failure(address(), "connecting", failure);
    connecting_ = false;
    return {};
  }

  Status send_waiting() {
    while (!waiting_.empty()) {
      const ssize_t sent =
          is_socket_ ? ::send(stream_.get(), waiting_.data(), waiting_.size(), MSG_NOSIGNAL)
                     : ::write(stream_.get(), waiting_.data(), waiting_.size());
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {};
      if (sent < 0) return system_failure(address(), "sending", errno);
      waiting_.erase(waiting_.begin(), waiting_.begin() + sent);
    }
    return {};
  }

  bool do_send(PeerId /*peer*/, std::span<const std::uint8_t> bytes) override {
    if (!connected() || waiting_.size() + bytes.size() > kMaxWaitingBytes) return false;
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    // A failure is found again by the next exchange.
    return send_waiting().ok();
  }

  bool is_socket_;
  FileDescriptor stream_;
  bool connecting_;
  TimePoint heard_;
  std::vector<std::uint8_t> buffer_;
  std::vector<std::uint8_t> waiting_;  ///< to be sent
};

/// Small messages are sent at once.
void send_without_delay(int socket) {
  const int on = 1;
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

/// Ends a connection whose other side does not acknowledge for kSilenceLimit, also while nothing is
/// sent: a machine that was switched off or lost its network closes no connection.
void end_when_unanswered(int socket) {
  const int on = 1;
  const int idle_s = static_cast<int>(kSilenceLimit.count()) / 2;
  const int interval_s = 1;
  const auto limit_ms = static_cast<unsigned>(std::chrono::milliseconds(kSilenceLimit).count());
  (void)::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &interval_s, sizeof interval_s);
  (void)::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &limit_ms, sizeof limit_ms);
}

class ListeningLink final : public StreamLink {
 public:
  ListeningLink(const LinkAddress& address,
                bool read_only,
                bool keeps_silent_peers,
                FileDescriptor listener)
      : StreamLink(address, read_only, {}, false),
        keeps_silent_peers_(keeps_silent_peers),
        listener_(std::move(listener)) {}

  using ByteLink::set_port;

  void add_to_poll(std::vector<pollfd>& descriptors) const override {
    descriptors.push_back({listener_.get(), POLLIN, 0});
    StreamLink::add_to_poll(descriptors);
  }
  [[nodiscard]] Status exchange(TimePoint now, const Take& take, const Replace& replace) override {
    if (has_stream()) {
      // The end of a connection is not the end of this link.
      if (Status status = StreamLink::exchange(now, take, replace); !status) use({}, now);
    }
    FileDescriptor accepted(
        ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!accepted.open() || (has_stream() && !gives_way(now))) return {};
    send_without_delay(accepted.get());
    end_when_unanswered(accepted.get());
    use(std::move(accepted), now);
    replace(0);
    return {};
  }

 private:
  [[nodiscard]] bool gives_way(TimePoint now) const {
    return !keeps_silent_peers_ && now - heard() > kSilenceLimit;
  }

  bool keeps_silent_peers_;
  FileDescriptor listener_;
};

speed_t speed_of(std::uint32_t baud_rate) {
  switch (baud_rate) {
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 115200:
      return B115200;
    case 230400:
      return B230400;
    case 460800:
      return B460800;
    case 500000:
      return B500000;
    case 576000:
      return B576000;
    case 921600:
      return B921600;
    case 1000000:
      return B1000000;
    case 1500000:
      return B1500000;
    case 2000000:
      return B2000000;
    case 3000000:
      return B3000000;
    default:
      return B57600;
  }
}

Status set_raw_mode(int device, const LinkAddress& address) {
  termios settings{};
  if (::tcgetattr(device, &settings) != 0) return system_failure(address, "settings", errno);
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB | PARENB);
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  const speed_t speed = speed_of(address.baud_rate);
  if (::cfsetispeed(&settings, speed) != 0 || ::cfsetospeed(&settings, speed) != 0 ||
      ::tcsetattr(device, TCSANOW, &settings) != 0) {
    return system_failure(address, "setting the baud rate", errno);
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<ByteLink>> connect_tcp(const LinkAddress& address, bool read_only) {
  const SocketAddress name = socket_address(address);
  Result<FileDescriptor> socket = open_socket(address, name.family(), SOCK_STREAM);
  if (!socket) return socket.error();
  send_without_delay(socket->get());
  end_when_unanswered(socket->get());
  const bool connecting = ::connect(socket->get(), name.get(), name.size) != 0;
  if (connecting && errno != EINPROGRESS) return system_failure(address, "connecting", errno);
  return std::unique_ptr<ByteLink>(
      std::make_unique<StreamLink>(address, read_only, std::move(*socket), connecting));
}

Result<std::unique_ptr<ByteLink>> listen_tcp(const LinkAddress& address,
                                             bool read_only,
                                             bool keeps_silent_peers) {
  const SocketAddress name = socket_address(address);
  Result<FileDescriptor> socket = open_socket(address, name.family(), SOCK_STREAM);
  if (!socket) return socket.error();
  const int number = socket->get();
  const int on = 1;
  (void)::setsockopt(number, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const Result<std::uint16_t> port = bind_socket(number, address);
  if (!port) return port.error();
  if (::listen(number, 4) != 0) return system_failure(address, "listening", errno);
  auto link =
      std::make_unique<ListeningLink>(address, read_only, keeps_silent_peers, std::move(*socket));
  link->set_port(*port);
  return std::unique_ptr<ByteLink>(std::move(link));
}

Result<std::unique_ptr<ByteLink>> open_serial(const LinkAddress& address, bool read_only) {
  const int access = read_only ? O_RDONLY : O_RDWR;
  FileDescriptor device(::open(address.device.c_str(), access | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!device.open()) return system_failure(address, "opening", errno);
  struct stat status {};
  if (::fstat(device.get(), &status) != 0 || !S_ISCHR(status.st_mode) ||
      ::isatty(device.get()) != 1) {
    return Error{ErrorCode::kInvalidArgument, address.text() + ": is not a serial device"};
  }
  // Best effort: another program that reads the device would take half of the bytes.
  (void)::ioctl(device.get(), TIOCEXCL);
  if (Status set = set_raw_mode(device.get(), address); !set) return set.error();
  return std::unique_ptr<ByteLink>(
      std::make_unique<StreamLink>(address, read_only, std::move(device), false));
}

}  // namespace overfly::flight::mavlink
