#include "server/experiments/keys/program_files.hpp"

#include <elf.h>

#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>

#include "core/outside/file_text.hpp"
#include "vo_bridges/process/child/program.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostLibraries = 200;
constexpr std::size_t kMostNames = 1000;   ///< that one file needs
constexpr std::size_t kMostFolders = 100;  ///< that one file names for them
constexpr std::size_t kMostHeaders = 1000;
constexpr std::size_t kMostEntries = 10'000;
constexpr std::size_t kMostTextBytes = std::size_t{16} << 20U;

/// `count` values from an offset of a file; empty if they are not there or more than `most`.
template <typename Value>
std::vector<Value> values_at(const ReadableFile& file,
                             std::uint64_t offset,
                             std::uint64_t count,
                             std::size_t most) {
  if (count > most) return {};
  std::vector<Value> values(count);
  auto* const bytes = reinterpret_cast<std::uint8_t*>(values.data());
  if (!file.read_at(offset, {bytes, count * sizeof(Value)})) return {};
  return values;
}

/// What a program or library says of the libraries that it needs.
struct Needs {
  std::vector<std::string> names;
  std::vector<fs::path> rpath;    ///< empty if there is a run path
  std::vector<fs::path> runpath;  ///< searched after LD_LIBRARY_PATH
  bool has_runpath = false;
};

/// A file of a program, and the one that needs it.
struct LoadedFile {
  fs::path file;
  std::optional<std::size_t> loader;  ///< index; empty for the program
  Needs needs;
};

std::vector<std::string> parts_of(std::string_view list) {
  std::vector<std::string> parts;
  while (!list.empty()) {
    const std::size_t colon = list.find(':');
    if (colon != 0) parts.emplace_back(list.substr(0, colon));
    if (colon == std::string_view::npos) break;
    list.remove_prefix(colon + 1);
  }
  return parts;
}

/// With the folder of the file in place of $ORIGIN.
fs::path without_origin(std::string folder, const fs::path& file) {
  for (const std::string_view name : {"${ORIGIN}", "$ORIGIN"}) {
    const std::size_t at = folder.find(name);
    if (at != std::string::npos) folder.replace(at, name.size(), file.parent_path().string());
  }
  return folder;
}

/// @param list  of DT_RPATH or DT_RUNPATH
std::vector<fs::path> folders_of(const std::string& list, const fs::path& file) {
  std::vector<fs::path> folders;
  for (const std::string& folder : parts_of(list)) {
    if (folders.size() == kMostFolders) break;
    folders.push_back(without_origin(folder, file));
  }
  return folders;
}

/// The offset in the file of an address in memory.
std::optional<std::uint64_t> offset_of(std::uint64_t address,
                                       const std::vector<Elf64_Phdr>& parts) {
  for (const Elf64_Phdr& part : parts) {
    if (part.p_type == PT_LOAD && address >= part.p_vaddr &&
        address - part.p_vaddr < part.p_filesz) {
      return part.p_offset + (address - part.p_vaddr);
    }
  }
  return std::nullopt;
}

/// Nothing for a file that is no 64-bit ELF file of this machine's byte order, or a broken one.
Needs needs_of(const fs::path& file) {
  const Result<ReadableFile> opened = ReadableFile::open(file);
  if (!opened) return {};
  const auto header = values_at<Elf64_Ehdr>(*opened, 0, 1, 1);
  if (header.empty() || std::memcmp(header[0].e_ident, ELFMAG, SELFMAG) != 0 ||
      header[0].e_ident[EI_CLASS] != ELFCLASS64 || header[0].e_ident[EI_DATA] != ELFDATA2LSB ||
      header[0].e_phentsize != sizeof(Elf64_Phdr)) {
    return {};
  }
  const auto parts =
      values_at<Elf64_Phdr>(*opened, header[0].e_phoff, header[0].e_phnum, kMostHeaders);
  std::vector<Elf64_Dyn> entries;
  for (const Elf64_Phdr& part : parts) {
    if (part.p_type != PT_DYNAMIC) continue;
    entries = values_at<Elf64_Dyn>(
        *opened, part.p_offset, part.p_filesz / sizeof(Elf64_Dyn), kMostEntries);
  }
  std::uint64_t text_address = 0;
  std::uint64_t text_bytes = 0;
  for (const Elf64_Dyn& entry : entries) {
    if (entry.d_tag == DT_STRTAB) text_address = entry.d_un.d_ptr;
    if (entry.d_tag == DT_STRSZ) text_bytes = entry.d_un.d_val;
  }
  const auto text_offset = offset_of(text_address, parts);
  if (!text_offset) return {};
  const std::vector<char> texts =
      values_at<char>(*opened, *text_offset, text_bytes, kMostTextBytes);
  Needs needs;
  for (const Elf64_Dyn& entry : entries) {
    if (entry.d_tag == DT_NULL) break;
    if (entry.d_un.d_val >= texts.size()) continue;
    const char* const begin = texts.data() + entry.d_un.d_val;
    const std::string text(begin, ::strnlen(begin, texts.size() - entry.d_un.d_val));
    if (entry.d_tag == DT_NEEDED && needs.names.size() < kMostNames) needs.names.push_back(text);
    if (entry.d_tag == DT_RPATH) needs.rpath = folders_of(text, file);
    if (entry.d_tag == DT_RUNPATH) {
      needs.runpath = folders_of(text, file);
      needs.has_runpath = true;
    }
  }
  if (needs.has_runpath) needs.rpath.clear();
  return needs;
}

/// Where the dynamic linker looks for what a file needs, before the system's folders (ld.so(8)): in
/// the RPATH of the file and of those that needed it, unless it has a RUNPATH; in
/// LD_LIBRARY_PATH; in its RUNPATH.
std::vector<fs::path> search_folders(const std::vector<LoadedFile>& files,
                                     std::size_t file,
                                     const std::vector<std::string>& library_path) {
  std::vector<fs::path> folders;
  const Needs& needs = files[file].needs;
  if (!needs.has_runpath) {
    for (std::optional<std::size_t> i = file; i; i = files[*i].loader) {
      const std::vector<fs::path>& rpath = files[*i].needs.rpath;
      folders.insert(folders.end(), rpath.begin(), rpath.end());
    }
  }
  folders.insert(folders.end(), library_path.begin(), library_path.end());
  folders.insert(folders.end(), needs.runpath.begin(), needs.runpath.end());
  return folders;
}

}  // namespace

std::vector<fs::path> program_files(const std::string& program) {
  const Result<fs::path> found = process::find_program(program);
  if (!found) return {};
  const char* const variable = std::getenv("LD_LIBRARY_PATH");
  const std::vector<std::string> library_path = parts_of(variable != nullptr ? variable : "");
  std::vector<LoadedFile> files;
  files.push_back({*found, std::nullopt, needs_of(*found)});
  // The first search for a name decides: the linker does not look for it again.
  std::set<std::string> names;
  std::set<fs::path> seen{*found};
  for (std::size_t i = 0; i < files.size() && files.size() < kMostLibraries; ++i) {
    const std::vector<fs::path> folders = search_folders(files, i, library_path);
    const std::vector<std::string> needed = files[i].needs.names;
    for (const std::string& name : needed) {
      if (!names.insert(name).second) continue;
      for (const fs::path& folder : folders) {
        fs::path library = (folder / name).lexically_normal();
        if (!check_regular_file(library).ok()) continue;
        if (seen.insert(library).second) {
          Needs needs = needs_of(library);
          files.push_back({std::move(library), i, std::move(needs)});
        }
        break;
      }
    }
  }
  std::vector<fs::path> paths;
  for (LoadedFile& file : files) paths.push_back(std::move(file.file));
  return paths;
}

}  // namespace overfly::server::experiments
