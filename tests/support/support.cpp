#include "tests/support/support.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace overfly::testing {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "overfly-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp failed: " + pattern);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::optional<fs::path> shared_data(const std::string& relative) {
  const char* from_environment = std::getenv("OVERFLY_DATA");
  const fs::path root = from_environment != nullptr
                            ? fs::path(from_environment)
                            : fs::path(OVERFLY_SOURCE_DIR) / ".." / "shared" / "data";
  fs::path file = (root / relative).lexically_normal();
  if (!fs::exists(file)) return std::nullopt;
  return file;
}

fs::path source_file(const std::string& relative) {
  return fs::path(OVERFLY_SOURCE_DIR) / relative;
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace overfly::testing
