// Files made of one fuzzer's input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace overfly::fuzz {

/// The bytes of an input.
[[nodiscard]] inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Takes the first line off `rest`, without its line feed.
[[nodiscard]] std::string_view take_line(std::string_view* rest);

/// Cuts an input into files. `=== PATH` on a separate line begins one; of equal names the last
/// counts. Names that are not plain relative paths are left out, and all beyond the first 24.
[[nodiscard]] std::map<std::string, std::string_view> files_in(std::string_view input);

/// One folder of this process, in memory where the system has such a place.
class InputFolder {
 public:
  static InputFolder& of_process();
  ~InputFolder();
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  /// The folder, holding these files and nothing else.
  const std::filesystem::path& fill(const std::map<std::string, std::string_view>& files);
  /// A file of this name with these bytes, as the only one in the folder.
  std::filesystem::path file(const std::string& name, std::string_view bytes);

 private:
  InputFolder();
  std::filesystem::path path_;
};

}  // namespace overfly::fuzz
