// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kestrel {

// A CSV text with a header row: comma-separated, no quotes (the EuRoC / ASL form). Every error is
// an InputError that names the file and the line.
class CsvTable {
 public:
  // 'text' must outlive the table; 'file' is for messages. A '#' before the header, blanks around
  // cells, '\r' and empty lines are tolerated; a row of another width than the header's is not.
  CsvTable(std::string_view text, std::string file);

  std::size_t row_count() const { return rows_.size(); }

  // Index of the column 'name'; the header's names are compared without their blanks. FindColumn:
  // nothing where there is none, which Column throws for.
  std::size_t Column(std::string_view name) const;
  std::optional<std::size_t> FindColumn(std::string_view name) const;

  std::string_view Text(std::size_t row, std::size_t column) const;
  double Number(std::size_t row, std::size_t column) const;  // finite
  std::int64_t Integer(std::size_t row, std::size_t column) const;

  // For values that may be unknown: whether the cell is empty; its number, nothing when it is.
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

// 'text' as one cell (RFC 4180): with a comma, a quote or a line break in it, it is put in quotes.
std::string CsvCell(const std::string& text);

}  // namespace kestrel
