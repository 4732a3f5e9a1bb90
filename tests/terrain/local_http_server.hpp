// A web server on the loopback for tests: one handler decides every answer, right or wrong.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace overfly::testing {

struct HttpRequest {
  std::string path;                          ///< without the query
  std::map<std::string, std::string> query;  ///< not percent-decoded
  std::string user_agent;
};

struct HttpAnswer {
  int status = 200;
  std::string content_type = "application/octet-stream";
  std::string body;
  std::vector<std::string> headers;      ///< "Name: value"
  std::optional<std::size_t> cut_after;  ///< send only this number of bytes of the body, then close
};

class LocalHttpServer {
 public:
  /// Called on the server's threads, several at a time.
  using Handler = std::function<HttpAnswer(const HttpRequest&)>;
  explicit LocalHttpServer(Handler handler);
  ~LocalHttpServer();
  LocalHttpServer(const LocalHttpServer&) = delete;
  LocalHttpServer& operator=(const LocalHttpServer&) = delete;

  /// "http://127.0.0.1:PORT"
  [[nodiscard]] std::string address() const;
  [[nodiscard]] int requests() const { return requests_.load(); }
  /// Requests whose answer was being thought out.
  [[nodiscard]] int most_at_a_time() const { return most_at_a_time_.load(); }

 private:
  void accept_all();
  void serve(int socket);

  Handler handler_;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<bool> stop_{false};
  std::atomic<int> requests_{0};
  std::atomic<int> running_{0};
  std::atomic<int> most_at_a_time_{0};
  std::mutex mutex_;
  std::vector<std::thread> connections_;
  std::thread acceptor_;
};

}  // namespace overfly::testing
