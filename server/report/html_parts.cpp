#include "server/report/html_parts.hpp"

#include "server/files/build_info.hpp"
#include "server/report/page_style.hpp"
#include "server/report/plot/markup.hpp"

namespace overfly::server::report {
namespace {

using plot::escaped;

std::string opening(const std::string& tag, const Cell& cell) {
  std::string css_class = cell.number ? "n" : "";
  if (cell.best) css_class += css_class.empty() ? "best" : " best";
  std::string markup = "<" + tag;
  if (!css_class.empty()) markup += " class=\"" + css_class + "\"";
  if (cell.columns > 1) markup += " colspan=\"" + std::to_string(cell.columns) + "\"";
  return markup + ">";
}

std::string content_of(const Cell& cell) {
  if (!cell.best) return escaped(cell.text);
  return escaped(cell.text) + " <span aria-hidden=\"true\">\xE2\x98\x85</span>" +
         "<span class=\"unseen\"> (best)</span>";
}

}  // namespace

std::string program_text() { return version() + ", commit " + git_commit(); }

std::string page_start(const std::string& title) {
  constexpr std::size_t kLongestTitle = 240;
  // Nothing is loaded and no script runs, even if a text were not escaped.
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
         "data:; "
         "style-src 'unsafe-inline'\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"generator\" content=\"Overfly " +
         escaped(program_text()) + "\">\n<title>" + escaped(title, kLongestTitle) +
         "</title>\n<style>\n" + style_sheet() + "</style>\n</head>\n<body>\n";
}

std::string heading(int level, const std::string& text) {
  const std::string tag = "h" + std::to_string(level);
  return "<" + tag + ">" + escaped(text) + "</" + tag + ">\n";
}

std::string paragraph(const std::string& text, const std::string& css_class) {
  const std::string open = css_class.empty() ? "<p>" : "<p class=\"" + css_class + "\">";
  return open + escaped(text) + "</p>\n";
}

std::string table(const Table& table) {
  std::string markup = "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"" +
                       escaped(table.caption, 200) +
                       (table.fields ? "\"><table class=\"fields\">\n" : "\"><table>\n") +
                       "<caption><span>" + escaped(table.caption) +
                       "</span></caption>\n<thead><tr>";
  for (const Cell& cell : table.head) {
    markup += opening("th scope=\"col\"", cell) + content_of(cell) + "</th>";
  }
  markup += "</tr></thead>\n<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    markup += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool heads = i == 0;
      markup += opening(heads ? "th scope=\"row\"" : "td", row[i]) + content_of(row[i]) +
                (heads ? "</th>" : "</td>");
    }
    markup += "</tr>\n";
  }
  return markup + "</tbody></table></div>\n";
}

std::string folded(const std::string& summary, const std::string& content) {
  return "<details><summary>" + escaped(summary) + "</summary>\n" + content + "</details>\n";
}

std::string figure(const std::string& title,
                   const std::string& caption,
                   const std::string& drawing) {
  return "<figure>\n<figcaption><strong>" + escaped(title) + "</strong> " + escaped(caption) +
         "</figcaption>\n" + drawing + "</figure>\n";
}

}  // namespace overfly::server::report
