#include "terrain/raster/crs_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string_view>

#include "core/text/lower_case.hpp"
#include "core/text/pattern.hpp"

namespace overfly::terrain {
namespace {

constexpr std::size_t kLongest = 32'768;  ///< the longest WKT of EPSG has about 20 000 characters

bool is_code(const std::string& text) {
  return text.size() <= 80 &&
         matches_pattern(text,
                         "(EPSG|ESRI|IGNF|OGC|IAU_2015):[A-Za-z0-9_]{1,40}(\\+[0-9]{1,10})?",
                         LetterCase::kAny);
}

bool is_wkt(const std::string& text) {
  static constexpr std::array<std::string_view, 11> kKeywords = {"projcs",
                                                                 "geogcs",
                                                                 "compd_cs",
                                                                 "projcrs",
                                                                 "projectedcrs",
                                                                 "geogcrs",
                                                                 "geographiccrs",
                                                                 "geodcrs",
                                                                 "geodeticcrs",
                                                                 "compoundcrs",
                                                                 "boundcrs"};
  const std::size_t open = text.find('[');
  if (open == std::string::npos) return false;
  std::string keyword = lower_case(text.substr(0, std::min<std::size_t>(open, 40)));
  keyword.erase(keyword.find_last_not_of(" \t\r\n") + 1);
  return std::find(kKeywords.begin(), kKeywords.end(), keyword) != kKeywords.end();
}

/// "a.tif,@b.gtx", "@null": names that PROJ looks up among its own grids.
bool are_bare_names(const std::string& text) {
  const auto allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == ',' || c == '@';
  };
  return std::all_of(text.begin(), text.end(), allowed) && text.find("..") == std::string::npos;
}

bool is_number(const std::string& text) {
  return text.find_first_not_of("0123456789.+-/eE") == std::string::npos && text.front() != '/' &&
         text.find("..") == std::string::npos;
}

/// True if no `+key=value` of a PROJ text names a location in a file system or a network; `+init`
/// always reads a file.
bool is_safe_proj_text(const std::string& text) {
  std::istringstream parts(text);
  for (std::string part; parts >> part;) {
    const std::size_t equals = part.find('=');
    const std::string key = lower_case(part.substr(0, equals));
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    if (key == "+init" || key == "init") return false;
    const bool grid = key.find("grid") != std::string::npos;
    if (grid ? !are_bare_names(value)
             : value.find_first_of("/\\~:@") != std::string::npos && !is_number(value)) {
      return false;
    }
  }
  return true;
}

/// Checks the parts of WKT that may name a file: extensions with PROJ texts or grids, and the grids
/// of a bound system.
bool is_safe_wkt(const std::string& text) {
  const std::string all = lower_case(text);
  for (const std::string_view keyword : {"extension", "parameterfile"}) {
    for (std::size_t at = all.find(keyword); at != std::string::npos;
         at = all.find(keyword, at + 1)) {
      // KEYWORD["NAME","VALUE"]
      std::size_t quote = at;
      for (int i = 0; i < 3 && quote != std::string::npos; ++i) quote = all.find('"', quote + 1);
      if (quote == std::string::npos) return false;
      const std::size_t end = all.find('"', quote + 1);
      if (end == std::string::npos) return false;
      const std::string value = all.substr(quote + 1, end - quote - 1);
      if (value.find("+proj") != std::string::npos ? !is_safe_proj_text(value)
                                                   : !are_bare_names(value)) {
        return false;
      }
    }
  }
  return true;
}

bool is_proj_text(const std::string& text) {
  return text.starts_with("+") && lower_case(text).find("+proj=") != std::string::npos;
}

}  // namespace

Status check_crs_text(const std::string& text, const std::string& field) {
  const bool safe = text.size() <= kLongest && text.find('\0') == std::string::npos &&
                    (is_code(text) || (is_wkt(text) && is_safe_wkt(text)) ||
                     (is_proj_text(text) && is_safe_proj_text(text)));
  if (safe) return {};
  constexpr std::size_t kShown = 80;
  const std::string shown = text.size() > kShown ? text.substr(0, kShown) + "..." : text;
  return Error{ErrorCode::kInvalidArgument,
               field + " = \"" + shown +
                   "\": must be an authority's code (EPSG:32616), WKT or PROJ text, and name no "
                   "file or address"};
}

}  // namespace overfly::terrain
