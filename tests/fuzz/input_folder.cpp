#include "tests/fuzz/input_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace overfly::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = "=== ";
constexpr std::size_t kMostFiles = 24;

bool is_plain(std::string_view name) {
  if (name.empty() || name.size() > 80 || name.front() == '/') return false;
  if (name.find("..") != std::string_view::npos) return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-' || c == '/';
  });
}

}  // namespace

std::string_view take_line(std::string_view* rest) {
  const std::size_t end = std::min(rest->find('\n'), rest->size());
  const std::string_view line = rest->substr(0, end);
  rest->remove_prefix(std::min(end + 1, rest->size()));
  return line;
}

std::map<std::string, std::string_view> files_in(std::string_view input) {
  std::map<std::string, std::string_view> files;
  std::string_view* content = nullptr;
  while (!input.empty() && files.size() < kMostFiles) {
    const char* const begin = input.data();
    const std::string_view line = take_line(&input);
    if (line.starts_with(kMark)) {
      const std::string_view name = line.substr(kMark.size());
      content = is_plain(name) ? &files[std::string(name)] : nullptr;
      if (content != nullptr) *content = input.substr(0, 0);
    } else if (content != nullptr) {
      if (content->empty()) *content = std::string_view(begin, 0);
      const char* const end = input.empty() ? begin + line.size() : input.data();
      *content = {content->data(), static_cast<std::size_t>(end - content->data())};
    }
  }
  return files;
}

InputFolder& InputFolder::of_process() {
  static InputFolder folder;
  return folder;
}

InputFolder::InputFolder() {
  std::error_code ignored;
  const fs::path memory = "/dev/shm";
  const fs::path parent = fs::is_directory(memory, ignored) ? memory : fs::temp_directory_path();
  std::string pattern = (parent / "overfly-fuzz-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    std::perror(pattern.c_str());
    std::abort();
  }
  path_ = pattern;
}

InputFolder::~InputFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

const fs::path& InputFolder::fill(const std::map<std::string, std::string_view>& files) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, ignored)) {
    fs::remove_all(entry.path(), ignored);
  }
  for (const auto& [name, bytes] : files) {
    const fs::path file = path_ / name;
    fs::create_directories(file.parent_path(), ignored);
    // A name that is a folder already stays one.
    std::ofstream(file, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  return path_;
}

fs::path InputFolder::file(const std::string& name, std::string_view bytes) {
  return fill({{name, bytes}}) / name;
}

}  // namespace overfly::fuzz
