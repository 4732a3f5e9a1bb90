#include "tests/server/imagery/raw_rtsp_server.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace overfly::testing {
namespace {

void put16(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

void put32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  put16(bytes, value >> 16U);
  put16(bytes, value & 0xFFFFU);
}

bool send_bytes(int socket, const void* bytes, std::size_t count) {
  const auto* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t sent = ::send(socket, at, count, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    at += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

std::string header_of(const std::string& request, const std::string& name) {
  const std::size_t begin = request.find("\r\n" + name + ": ");
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + name.size() + 4;
  return request.substr(from, request.find("\r\n", from) - from);
}

}  // namespace

RawRtspServer::RawRtspServer(Image image, bool silent) : image_(std::move(image)), silent_(silent) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, plain, size) != 0 || ::listen(listener_, 1) != 0 ||
      ::getsockname(listener_, plain, &size) != 0) {
    throw std::runtime_error("the RTSP server cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

RawRtspServer::~RawRtspServer() {
  stop_ = true;
  thread_.join();
  ::close(listener_);
}

std::string RawRtspServer::address() const {
  return "rtsp://127.0.0.1:" + std::to_string(port_) + "/live";
}

std::string RawRtspServer::requests() {
  const std::lock_guard lock(mutex_);
  return requests_;
}

void RawRtspServer::wait_for_client() {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, std::chrono::seconds(30), [&] { return connected_; });
}

void RawRtspServer::serve() {
  int client = -1;
  std::string unread;
  std::uint32_t timestamp = 0;
  while (!stop_) {
    pollfd waiting{client < 0 ? listener_ : client, POLLIN, 0};
    const bool readable = ::poll(&waiting, 1, 20) > 0;
    if (client < 0) {
      if (readable) client = ::accept(listener_, nullptr, nullptr);
      const std::lock_guard lock(mutex_);
      connected_ = client >= 0;
      arrived_.notify_all();
      continue;
    }
    if (readable) {
      char bytes[4096];
      const ssize_t got = ::recv(client, bytes, sizeof bytes, 0);
      if (got <= 0) break;
      unread.append(bytes, static_cast<std::size_t>(got));
      const std::lock_guard lock(mutex_);
      requests_.append(bytes, static_cast<std::size_t>(got));
    }
    for (std::size_t end = 0; (end = unread.find("\r\n\r\n")) != std::string::npos;) {
      if (!silent_) answer(client, unread.substr(0, end + 2));
      unread.erase(0, end + 4);
    }
    if (playing_ && !send_image(client, timestamp += 3000)) break;
  }
  if (client >= 0) ::close(client);
}

void RawRtspServer::answer(int socket, const std::string& request) {
  std::string reply = "RTSP/1.0 200 OK\r\nCSeq: " + header_of(request, "CSeq") + "\r\n";
  std::string body;
  if (request.starts_with("OPTIONS")) {
    reply += "Public: OPTIONS, DESCRIBE, SETUP, PLAY, TEARDOWN\r\n";
  } else if (request.starts_with("DESCRIBE")) {
    body = "v=0\r\no=- 0 0 IN IP4 127.0.0.1\r\ns=test\r\nt=0 0\r\nm=video 0 RTP/AVP 96\r\n"
           "a=rtpmap:96 raw/90000\r\na=fmtp:96 sampling=YCbCr-4:2:2; width=" +
           std::to_string(image_.width_px) + "; height=" + std::to_string(image_.height_px) +
           "; depth=8; colorimetry=BT601-5\r\na=control:track1\r\n";
    reply += "Content-Type: application/sdp\r\nContent-Length: " + std::to_string(body.size()) +
             "\r\n";
  } else if (request.starts_with("SETUP")) {
    reply += "Transport: RTP/AVP/TCP;unicast;interleaved=0-1\r\nSession: 1\r\n";
  } else if (request.starts_with("PLAY")) {
    reply += "Session: 1\r\n";
    playing_ = true;
  }
  reply += "\r\n" + body;
  (void)send_bytes(socket, reply.data(), reply.size());
}

bool RawRtspServer::send_image(int socket, std::uint32_t timestamp) {
  for (int y = 0; y < image_.height_px; ++y) {
    std::vector<std::uint8_t> packet;
    const bool last = y + 1 == image_.height_px;
    packet.push_back(0x80);  // version 2
    packet.push_back(static_cast<std::uint8_t>(96U | (last ? 0x80U : 0U)));
    put16(packet, sequence_++);
    put32(packet, timestamp);
    put32(packet, 7);  // source
    put16(packet, 0);  // high bits of the sequence number
    put16(packet, static_cast<std::uint32_t>(2 * image_.width_px));
    put16(packet, static_cast<std::uint32_t>(y));
    put16(packet, 0);  // first pixel
    for (int x = 0; x < image_.width_px; ++x) {
      packet.push_back(128);
      packet.push_back(image_.at(x, y));
    }
    std::vector<std::uint8_t> frame = {'$', 0};
    put16(frame, static_cast<std::uint32_t>(packet.size()));
    frame.insert(frame.end(), packet.begin(), packet.end());
    if (!send_bytes(socket, frame.data(), frame.size())) return false;
  }
  return true;
}

}  // namespace overfly::testing
