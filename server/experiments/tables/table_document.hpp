// Headings, sentences and tables, to be written in several formats.
#pragma once

#include <string>
#include <vector>

namespace overfly::server::experiments {

struct TableCell {
  std::string text;
  bool best = false;  ///< the lowest of its group: highlighted
};

struct TableColumn {
  std::string head;
  bool number = false;  ///< aligned to the right
};

struct DocumentTable {
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;
};

struct DocumentSection {
  std::string heading;
  std::vector<std::string> paragraphs;
  DocumentTable table;
  std::vector<std::string> notes;  ///< below the table
};

struct TableDocument {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<DocumentSection> sections;
};

[[nodiscard]] std::string markdown_from(const TableDocument& document);
/// Tables of booktabs, to be included in a document.
[[nodiscard]] std::string latex_from(const TableDocument& document);
/// A page without scripts and network.
[[nodiscard]] std::string html_from(const TableDocument& document);

}  // namespace overfly::server::experiments
