#include "terrain/raster/crs_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string_view>
#include <vector>

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

/// PROJ takes white space next to ',' and '=' away, so that words belong together.
bool joins_words(const std::string& text) {
  const auto joins = [](char c) { return c == ',' || c == '='; };
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t i = 1; i < text.size(); ++i) {
    if ((joins(text[i - 1]) && is_space(text[i])) || (is_space(text[i - 1]) && joins(text[i]))) {
      return true;
    }
  }
  return false;
}

/// True if no `+key=value` of a PROJ text names a location in a file system or a network; `+init`
/// always reads a file.
bool is_safe_proj_text(const std::string& text) {
  if (joins_words(text) && text.find_first_of("/\\~:@") != std::string::npos) return false;
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

/// WKT, cut at its quotes: the strings at odd places, what is between them at even ones, without
/// spaces. Empty if a string is not a whole item of the text. PROJ joins `"a"b"c"` to one item.
std::vector<std::string> split_at_quotes(const std::string& text) {
  std::vector<std::string> pieces(1);
  for (const char c : text) {
    const bool between = pieces.size() % 2 == 1;
    if (c == '"') {
      pieces.emplace_back();
    } else if (!between || std::isspace(static_cast<unsigned char>(c)) == 0) {
      pieces.back() += c;
    }
  }
  const auto is_one_of = [](char c, std::string_view set) { return set.find(c) != set.npos; };
  for (std::size_t i = 0; i < pieces.size(); i += 2) {
    const std::string& between = pieces[i];
    if (between.empty() || (i > 0 && !is_one_of(between.front(), ",])")) ||
        (i + 1 < pieces.size() && !is_one_of(between.back(), ",[("))) {
      return {};
    }
  }
  return pieces.size() % 2 == 1 ? pieces : std::vector<std::string>();
}

/// Whether the pieces from `at` on are `... KEYWORD["NAME","VALUE"` with a VALUE that is a text of
/// PROJ or names no file.
bool is_safe_node(const std::vector<std::string>& pieces,
                  std::size_t at,
                  std::string_view keyword) {
  if (at + 4 >= pieces.size() || pieces[at + 2] != ",") return false;
  const std::string begin = pieces[at].substr(pieces[at].find(keyword));
  const std::string& value = pieces[at + 3];
  return begin.size() == keyword.size() + 1 && begin.back() != ',' &&
         (value.find('=') != std::string::npos || are_bare_names(value));
}

/// Checks the parts of WKT that may name a file: extensions with PROJ texts or grids, the grids of
/// a bound system, and methods that are PROJ texts.
bool is_safe_wkt(const std::string& text) {
  static constexpr std::array<std::string_view, 2> kKeywords = {"extension", "parameterfile"};
  const std::string all = lower_case(text);
  const auto contains = [&all](std::string_view part) { return all.find(part) != all.npos; };
  if (!contains("=") && !contains(kKeywords[0]) && !contains(kKeywords[1])) return true;
  // PROJ also takes the quotes of printed texts, and two quotes within a string for one.
  if (contains("\"\"") || contains("\xE2\x80\x9C") || contains("\xE2\x80\x9D")) return false;
  const std::vector<std::string> pieces = split_at_quotes(all);
  if (pieces.empty()) return false;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i % 2 == 1) {
      if (pieces[i].find('=') != std::string::npos && !is_safe_proj_text(pieces[i])) return false;
      continue;
    }
    for (const std::string_view keyword : kKeywords) {
      if (pieces[i].find(keyword) != std::string::npos && !is_safe_node(pieces, i, keyword)) {
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
