// A connection without a socket, which keeps what its client sends and asks for.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/net/stream/viewer_port.hpp"

namespace overfly::testing {

class FakePort final : public net::ViewerPort {
 public:
  using Bytes = std::vector<std::uint8_t>;

  void send_text(std::string text) override { texts.push_back(nlohmann::json::parse(text)); }
  void send_binary(Bytes message) override {
    if (keeps_unsent) unsent += message.size();
    binaries.push_back(std::move(message));
  }
  void send_picture(const net::PictureTicket& ticket,
                    Bytes head,
                    std::shared_ptr<const Bytes> jpeg) override {
    head.insert(head.end(), jpeg->begin(), jpeg->end());
    binaries.push_back(std::move(head));
    sending.push_back(ticket);
  }
  void draw(const net::PictureTicket& ticket, const server::PictureRequest& request) override {
    drawn.emplace_back(ticket, request);
  }
  void open_run(const std::string& run_id) override {
    ++opening;
    opened = run_id;
  }
  void open_newest_run() override {
    ++opening;
    opened = "the newest";
  }
  void work(std::function<std::function<void()>()> slow) override {
    works.push_back(std::move(slow));
  }
  [[nodiscard]] std::optional<double> picture_limit_hz() const override { return std::nullopt; }
  [[nodiscard]] std::size_t unsent_bytes() const override { return unsent; }

  std::vector<nlohmann::json> texts;
  std::vector<Bytes> binaries;              ///< pictures among them
  std::vector<net::PictureTicket> sending;  ///< pictures
  std::vector<std::pair<net::PictureTicket, server::PictureRequest>> drawn;
  std::deque<std::function<std::function<void()>()>> works;
  int opening = 0;
  std::string opened;  ///< the run asked for last
  bool keeps_unsent = false;
  std::size_t unsent = 0;
};

}  // namespace overfly::testing
