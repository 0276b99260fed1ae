// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kestrel {

// A CSV text with a header row: comma-separated, without quotes (the EuRoC / ASL form). All errors
// are InputErrors that name the file and the line.
class CsvTable {
 public:
  // 'text' must outlive the table; 'file' is its name for messages. A '#' before the header, blanks
  // around cells, '\r' and empty lines are accepted. A row with another number of cells than the
  // header is an error.
  CsvTable(std::string_view text, std::string file);

  std::size_t row_count() const { return rows_.size(); }

  // Return the index of the column 'name'; blanks around the header's names are ignored. Without
  // such a column FindColumn returns nothing, and Column throws.
  std::size_t Column(std::string_view name) const;
  std::optional<std::size_t> FindColumn(std::string_view name) const;

  std::string_view Text(std::size_t row, std::size_t column) const;
  double Number(std::size_t row, std::size_t column) const;  // finite
  std::int64_t Integer(std::size_t row, std::size_t column) const;

  // For values that may be unknown: true when the cell is empty; its number, or nothing when it is.
  bool IsEmpty(std::size_t row, std::size_t column) const;
  std::optional<double> OptionalNumber(std::size_t row, std::size_t column) const;

  [[noreturn]] void Fail(std::size_t row, const std::string& message) const;

 private:
  struct Row {
    std::size_t line;
    std::vector<std::string_view> cells;
  };
  void AddLine(std::size_t line, std::string_view content);
  [[noreturn]] void FailCell(std::size_t row, std::size_t column, const char* expected) const;

  std::string file_;
  std::vector<std::string_view> header_;
  std::vector<Row> rows_;
};

// Returns 'text' as one cell (RFC 4180), in quotes if it contains a comma, a quote or a line break.
std::string CsvCell(const std::string& text);

}  // namespace kestrel
