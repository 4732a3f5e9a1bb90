// Runs a fuzz target without a fuzzer: `NAME_replay` over its committed corpus and some thousands
// of inputs made of it, `NAME_replay FILE...` over these files.
//
// Over the corpus, the input under way is in NAME_replay.input of the working folder, where it
// stays when the program ends by it.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "tests/fuzz/input_folder.hpp"
#include "tests/fuzz/replay/mutator.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Whether the target's parser accepts an input. Defined by targets whose seeds must be accepted,
/// because nothing behind the first error of an input is read. Seeds named `refused_...` must be
/// refused.
extern "C" [[gnu::weak]] bool overfly_fuzz_accepts(const std::uint8_t* data, std::size_t size);

namespace overfly::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMutations = 10'000;

fs::path folder_of_fuzzing() { return fs::path(OVERFLY_SOURCE_DIR) / "tests" / "fuzz"; }

std::optional<std::string> bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || !fs::is_regular_file(file)) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::vector<fs::path> corpus_of(const std::string& target) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_of_fuzzing() / "corpus" / target)) {
    files.push_back(entry.path());
  }
  // The order of folder entries differs between machines.
  std::sort(files.begin(), files.end());
  return files;
}

/// The text between the quotes of `"..."`: `\\`, `\"` and `\xAB` stand for one byte.
std::string unquoted(std::string_view quoted) {
  std::string word;
  for (std::size_t i = 0; i < quoted.size(); ++i) {
    if (quoted[i] != '\\') {
      word += quoted[i];
    } else if (quoted.substr(i + 1, 1) == "x") {
      word += static_cast<char>(std::stoi(std::string(quoted.substr(i + 2, 2)), nullptr, 16));
      i += 3;
    } else {
      word += quoted[++i];
    }
  }
  return word;
}

/// The words of a dictionary in libFuzzer's form; none where the target has no dictionary.
std::vector<std::string> words_of(const std::string& target) {
  std::vector<std::string> words;
  std::ifstream in(folder_of_fuzzing() / "dictionaries" / (target + ".dict"));
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find('"');
    const std::size_t last = line.rfind('"');
    if (line.starts_with('#') || first == last) continue;
    words.push_back(unquoted(std::string_view(line).substr(first + 1, last - first - 1)));
  }
  return words;
}

/// The file with the input under way. It is overwritten in place, because a file system may write
/// every new file to the disk.
class InputUnderWay {
 public:
  explicit InputUnderWay(fs::path path)
      : path_(std::move(path)), file_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ < 0) {
      std::perror(path_.c_str());
      std::exit(1);
    }
  }
  ~InputUnderWay() {
    ::close(file_);
    ::unlink(path_.c_str());
  }
  InputUnderWay(const InputUnderWay&) = delete;
  InputUnderWay& operator=(const InputUnderWay&) = delete;

  void write(const std::string& input) {
    if (::pwrite(file_, input.data(), input.size(), 0) != static_cast<ssize_t>(input.size()) ||
        ::ftruncate(file_, static_cast<off_t>(input.size())) != 0) {
      std::perror(path_.c_str());
      std::exit(1);
    }
  }

 private:
  fs::path path_;
  int file_;
};

void run(const std::string& input) {
  // A copy, so that a sanitizer sees a read beyond its end.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  (void)LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

/// The inputs in these files, or nothing and a line on standard error.
std::vector<std::string> read_all(const std::vector<fs::path>& files) {
  std::vector<std::string> inputs;
  for (const fs::path& file : files) {
    const auto bytes = bytes_of(file);
    if (!bytes) {
      std::fprintf(stderr, "%s: cannot be read\n", file.c_str());
      return {};
    }
    inputs.push_back(*bytes);
  }
  if (inputs.empty()) std::fprintf(stderr, "no inputs\n");
  return inputs;
}

int replay_files(const std::vector<fs::path>& files) {
  const std::vector<std::string> inputs = read_all(files);
  for (const std::string& input : inputs) run(input);
  return inputs.empty() ? 1 : 0;
}

/// False, and a line on standard error, for each seed that the target does not treat as its name
/// says.
bool seeds_are_as_named(const std::vector<fs::path>& files, const std::vector<std::string>& seeds) {
  bool as_named = true;
  for (std::size_t i = 0; overfly_fuzz_accepts != nullptr && i < seeds.size(); ++i) {
    const bool wanted = !files[i].filename().string().starts_with("refused_");
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(seeds[i].data());
    if (overfly_fuzz_accepts(bytes, seeds[i].size()) == wanted) continue;
    std::fprintf(stderr, "%s: %s\n", files[i].c_str(), wanted ? "is refused" : "is accepted");
    as_named = false;
  }
  return as_named;
}

int replay_corpus(const std::string& target) {
  const std::vector<fs::path> files = corpus_of(target);
  const std::vector<std::string> seeds = read_all(files);
  if (seeds.empty() || !seeds_are_as_named(files, seeds)) return 1;
  InputUnderWay under_way(target + "_replay.input");
  Mutator mutator(seeds, words_of(target));
  for (std::size_t i = 0; i < seeds.size() + kMutations; ++i) {
    const std::string input = i < seeds.size() ? seeds[i] : mutator.next();
    under_way.write(input);
    run(input);
  }
  return 0;
}

}  // namespace
}  // namespace overfly::fuzz

int main(int argc, char** argv) {
  using namespace overfly::fuzz;
  return argc > 1 ? replay_files({argv + 1, argv + argc}) : replay_corpus(OVERFLY_FUZZ_TARGET);
}
