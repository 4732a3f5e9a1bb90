#include "terrain/files/regular_files.hpp"

#include <cpl_vsi_virtual.h>
#include <sys/stat.h>

#include <cerrno>

namespace overfly::terrain {
namespace {

/// Forwards to GDAL's own file system, except for files that are not regular.
class RegularFiles final : public VSIFilesystemHandler {
 public:
  explicit RegularFiles(VSIFilesystemHandler& files) : files_(files) {}

  VSIVirtualHandle* Open(const char* name,
                         const char* access,
                         bool set_error,
                         CSLConstList options) override {
    return hidden(name) ? nullptr : files_.Open(name, access, set_error, options);
  }
  int Stat(const char* name, VSIStatBufL* facts, int flags) override {
    return hidden(name) ? -1 : files_.Stat(name, facts, flags);
  }
  int Unlink(const char* name) override { return files_.Unlink(name); }
  int Rename(const char* from, const char* to) override { return files_.Rename(from, to); }
  int Mkdir(const char* name, long mode) override { return files_.Mkdir(name, mode); }
  int Rmdir(const char* name) override { return files_.Rmdir(name); }
  char** ReadDirEx(const char* name, int most) override { return files_.ReadDirEx(name, most); }
  int IsCaseSensitive(const char* name) override { return files_.IsCaseSensitive(name); }
  GIntBig GetDiskFreeSpace(const char* name) override { return files_.GetDiskFreeSpace(name); }
  int SupportsSparseFiles(const char* name) override { return files_.SupportsSparseFiles(name); }
  VSIDIR* OpenDir(const char* name, int depth, const char* const* options) override {
    return files_.OpenDir(name, depth, options);
  }

 private:
  /// True for an existing file that is neither regular nor a folder; sets errno then.
  static bool hidden(const char* name) {
    struct stat facts {};
    if (::stat(name, &facts) != 0 || S_ISREG(facts.st_mode) || S_ISDIR(facts.st_mode)) return false;
    errno = ENOENT;
    return true;
  }

  VSIFilesystemHandler& files_;
};

}  // namespace

void show_regular_files_alone() {
  VSIFileManager::InstallHandler("", new RegularFiles(*VSIFileManager::GetHandler("")));
}

}  // namespace overfly::terrain
