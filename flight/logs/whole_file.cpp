#include "flight/logs/whole_file.hpp"

#include <unistd.h>

#include <string>
#include <system_error>

namespace overfly::flight::logs {

Status write_whole_file(const std::filesystem::path& file,
                        const std::function<void(std::ofstream&)>& write) {
  const std::filesystem::path unfinished = file.string() + ".part" + std::to_string(::getpid());
  std::error_code error;
  {
    std::ofstream out(unfinished, std::ios::binary | std::ios::trunc);
    write(out);
    if (!out.flush()) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) std::filesystem::rename(unfinished, file, error);
  if (!error) return {};
  std::error_code ignored;
  std::filesystem::remove(unfinished, ignored);
  return Error{ErrorCode::kIo, file.string() + ": cannot be written: " + error.message()};
}

}  // namespace overfly::flight::logs
