// Pieces of the page's HTML. Every text is escaped here.
#pragma once

#include <string>
#include <vector>

namespace overfly::server::report {

/// Version and commit of this build: "0.1.0, commit 1a2b3c4".
[[nodiscard]] std::string program_text();

/// A page up to its `<body>`, with the style sheet. Nothing is loaded and no script runs.
[[nodiscard]] std::string page_start(const std::string& title);

/// `<h2>` to `<h4>`. @param level  in [2, 4]
[[nodiscard]] std::string heading(int level, const std::string& text);
[[nodiscard]] std::string paragraph(const std::string& text, const std::string& css_class = "");

struct Cell {
  std::string text;
  bool number = false;  ///< aligned to the right
  bool best = false;    ///< marked
  int columns = 1;      ///< that it spans
};

struct Table {
  std::string caption;
  bool fields = false;  ///< of texts that may break anywhere: paths, digests
  std::vector<Cell> head;
  /// The first cell of a row is its heading.
  std::vector<std::vector<Cell>> rows;
};

/// A table that scrolls by itself where the page is too narrow.
[[nodiscard]] std::string table(const Table& table);

/// A part that is folded until it is opened. @param content  HTML
[[nodiscard]] std::string folded(const std::string& summary, const std::string& content);

/// @param drawing  SVG
[[nodiscard]] std::string figure(const std::string& title,
                                 const std::string& caption,
                                 const std::string& drawing);

}  // namespace overfly::server::report
