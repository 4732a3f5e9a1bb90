#include "server/app/token_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "server/net/http/access_token.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

/// The longest token, its line end, and one more byte to detect a longer file.
constexpr std::size_t kReadBytes = net::kMaxTokenCharacters + 3;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

Error failure(const fs::path& file, const char* what) {
  return {ErrorCode::kIo,
          "token file " + file.string() + ": " + what + ": " + std::strerror(errno)};
}

Error invalid(const fs::path& file, const std::string& what) {
  return {ErrorCode::kInvalidArgument, "token file " + file.string() + ": " + what};
}

/// Empty if the file already exists.
Result<std::optional<TokenFile>> make_file(const fs::path& file) {
  const Descriptor made(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (!made.is_open()) {
    if (errno == EEXIST) return std::optional<TokenFile>();
    return failure(file, "cannot be created");
  }
  auto token = net::make_token();
  if (!token) return token.error();
  const std::string line = *token + "\n";
  if (::write(made.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return failure(file, "cannot be written");
  }
  return std::optional<TokenFile>({std::move(*token), ""});
}

}  // namespace

Result<TokenFile> open_token_file(const fs::path& file) {
  auto made = make_file(file);
  if (!made) return made.error();
  if (*made) return **made;
  // Opening a pipe or a device must not block; both are rejected below.
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat status {};
  if (!opened.is_open() || ::fstat(opened.get(), &status) != 0) {
    return failure(file, "cannot be opened");
  }
  if (!S_ISREG(status.st_mode)) return invalid(file, "must be a regular file");
  std::array<char, kReadBytes> bytes{};
  const ssize_t count = ::read(opened.get(), bytes.data(), bytes.size());
  if (count < 0) return failure(file, "cannot be read");
  TokenFile read;
  read.token.assign(bytes.data(), static_cast<std::size_t>(count));
  if (read.token.ends_with('\n')) read.token.pop_back();
  if (read.token.ends_with('\r')) read.token.pop_back();
  if (read.token.find('\n') != std::string::npos) {
    return invalid(file, "must be one line, the token");
  }
  if (const Status valid = net::check_token(read.token); !valid) {
    return invalid(file, valid.error().message);
  }
  if ((status.st_mode & (S_IRGRP | S_IROTH)) != 0) {
    read.warning = "token file " + file.string() + " can be read by others: chmod 600 it";
  }
  return read;
}

}  // namespace overfly::app
