// Inside terrain only: the messages of GDAL and PROJ.
#pragma once

#include <cpl_error.h>

#include <filesystem>
#include <string>

namespace overfly::terrain {

/// Collects the messages of GDAL and PROJ on this thread instead of printing them. If several
/// objects exist, the newest receives them.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  [[nodiscard]] bool empty() const { return text_.empty(); }
  /// The messages, joined by "; "; "no reason given" if there are none.
  [[nodiscard]] std::string text() const;
  /// Passes the messages on to the object created before this one, if there is one.
  void pass_on() const;

 private:
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum number, const char* message);
  void add(std::string line);

  GdalMessages* outer_;
  std::string text_;
};

/// A warning with GDAL's messages about a file that was opened nevertheless.
[[nodiscard]] std::string heard_while_opening(const std::filesystem::path& file,
                                              const GdalMessages& messages);

}  // namespace overfly::terrain
