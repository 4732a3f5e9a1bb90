#include "server/experiments/tables/table_document.hpp"

#include <string_view>

#include "server/report/plot/markup.hpp"

namespace overfly::server::experiments {
namespace {

using Escape = std::string (*)(const std::string&);

/// Each character that has a replacement is replaced; line ends become spaces.
template <typename Replacement>
std::string escaped(const std::string& text, const Replacement& replacement) {
  std::string safe;
  for (const char c : text) {
    const std::string_view replaced = replacement(c);
    if (!replaced.empty()) {
      safe += replaced;
    } else {
      safe += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return safe;
}

std::string markdown_text(const std::string& text) {
  return escaped(text, [](char c) -> std::string_view {
    switch (c) {
      case '|':
        return "\\|";
      case '*':
        return "\\*";
      case '<':
        return "&lt;";
      case '`':
        return "\\`";
      default:
        return "";
    }
  });
}

std::string latex_text(const std::string& text) {
  return escaped(text, [](char c) -> std::string_view {
    switch (c) {
      case '\\':
        return "\\textbackslash{}";
      case '&':
        return "\\&";
      case '%':
        return "\\%";
      case '$':
        return "\\$";
      case '#':
        return "\\#";
      case '_':
        return "\\_";
      case '{':
        return "\\{";
      case '}':
        return "\\}";
      case '~':
        return "\\textasciitilde{}";
      case '^':
        return "\\textasciicircum{}";
      case '<':
        return "\\textless{}";
      case '>':
        return "\\textgreater{}";
      default:
        return "";
    }
  });
}

std::string html_text(const std::string& text) { return plot::escaped(text); }

std::string joined(const std::vector<std::string>& texts,
                   const std::string& before,
                   const std::string& after,
                   Escape escape) {
  std::string text;
  for (const std::string& part : texts) text += before + escape(part) + after;
  return text;
}

std::string markdown_table(const DocumentTable& table) {
  std::string text;
  for (const TableColumn& column : table.columns) text += "| " + markdown_text(column.head) + " ";
  text += "|\n";
  for (const TableColumn& column : table.columns) text += column.number ? "|---:" : "|---";
  text += "|\n";
  for (const std::vector<TableCell>& row : table.rows) {
    for (const TableCell& cell : row) {
      const std::string mark = cell.best ? "**" : "";
      text += "| " + mark + markdown_text(cell.text) + mark + " ";
    }
    text += "|\n";
  }
  return text + "\n";
}

std::string latex_table(const DocumentSection& section) {
  std::string columns;
  std::string head;
  for (const TableColumn& column : section.table.columns) {
    columns += column.number ? 'r' : 'l';
    head += (head.empty() ? "" : " & ") + latex_text(column.head);
  }
  std::string text = "\\begin{table}\n\\centering\n\\caption{" + latex_text(section.heading) +
                     ". " + joined(section.paragraphs, "", " ", latex_text) +
                     joined(section.notes, "", " ", latex_text) + "}\n\\begin{tabular}{" + columns +
                     "}\n\\toprule\n" + head + " \\\\\n\\midrule\n";
  for (const std::vector<TableCell>& row : section.table.rows) {
    // A row that began with "[" or "*" would be an argument of the line end before it.
    std::string line = "{}";
    for (const TableCell& cell : row) {
      const std::string shown = latex_text(cell.text);
      line += (&cell == row.data() ? "" : " & ") + (cell.best ? "\\textbf{" + shown + "}" : shown);
    }
    text += line + " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n\n";
}

std::string html_table(const DocumentTable& table) {
  std::string text = "<table>\n<thead><tr>";
  for (const TableColumn& column : table.columns) {
    text += std::string(column.number ? "<th class=\"number\">" : "<th>") + html_text(column.head) +
            "</th>";
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const std::vector<TableCell>& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool number = i < table.columns.size() && table.columns[i].number;
      const std::string shown = html_text(row[i].text);
      text += std::string(number ? "<td class=\"number\">" : "<td>") +
              (row[i].best ? "<strong>" + shown + "</strong>" : shown) + "</td>";
    }
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem;"
    "color:#1b1f24;background:#fff}"
    "h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem}"
    ".wide{overflow-x:auto}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums}"
    "th,td{padding:.25rem .7rem;border-bottom:1px solid #d5dae0;text-align:left;"
    "white-space:nowrap}"
    "th{border-bottom:2px solid #6b7684;vertical-align:bottom}"
    ".number{text-align:right}"
    "strong{background:#fff1a8;padding:0 .2rem;border-radius:.15rem}"
    ".notes{color:#4d5866;font-size:.9rem}"
    "@media print{body{margin:0;max-width:none;font-size:9pt}}";

}  // namespace

std::string markdown_from(const TableDocument& document) {
  std::string text = "# " + markdown_text(document.title) + "\n\n" +
                     joined(document.paragraphs, "", "\n\n", markdown_text);
  for (const DocumentSection& section : document.sections) {
    text += "## " + markdown_text(section.heading) + "\n\n" +
            joined(section.paragraphs, "", "\n\n", markdown_text) + markdown_table(section.table) +
            joined(section.notes, "", "\n\n", markdown_text);
  }
  return text;
}

std::string latex_from(const TableDocument& document) {
  std::string text = "% " + escaped(document.title, [](char) { return std::string_view(); }) +
                     "\n% Needs \\usepackage{booktabs}.\n\n" +
                     joined(document.paragraphs, "", "\n\n", latex_text);
  for (const DocumentSection& section : document.sections) text += latex_table(section);
  return text;
}

std::string html_from(const TableDocument& document) {
  const std::string title = html_text(document.title);
  std::string text =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      title + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n" +
      joined(document.paragraphs, "<p>", "</p>\n", html_text);
  for (const DocumentSection& section : document.sections) {
    text += "<h2>" + html_text(section.heading) + "</h2>\n" +
            joined(section.paragraphs, "<p>", "</p>\n", html_text) + "<div class=\"wide\">" +
            html_table(section.table) + "</div>\n" +
            joined(section.notes, "<p class=\"notes\">", "</p>\n", html_text);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace overfly::server::experiments
