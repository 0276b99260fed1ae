// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/report_page.h"

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr char kStyle[] =
    "body{max-width:60rem;margin:2rem auto;padding:0 1rem;font:1rem/1.5 system-ui,sans-serif;"
    "color:#1c2024;background:#fff}"
    "ul{padding:1rem 1rem 1rem 2rem;border-left:.3rem solid #009e73;background:#f2faf7;"
    "font-size:1.1rem}"
    "video,img{width:100%;height:auto;margin:.5rem 0}summary{cursor:pointer;color:#0b57a4}"
    "table{border-collapse:collapse;font-size:.85rem;margin-bottom:1rem}"
    "td,th{border:1px solid #ccd;padding:.2rem .5rem;text-align:right}"
    ".table{overflow-x:auto}";

std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string Row(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, Escaped(cell));
  return row + "</tr>\n";
}

std::string TableOf(const ReportTable& table) {
  std::string html = fmt::format("<h3>{}</h3>\n", Escaped(table.title));
  if (!table.note.empty()) html += fmt::format("<p>{}</p>\n", Escaped(table.note));
  html += "<div class=\"table\"><table>\n" + Row(table.columns, "th");
  for (const auto& row : table.rows) html += Row(row, "td");
  return html + "</table></div>\n";
}

std::string Chapter(const PageChapter& chapter) {
  std::string html =
      fmt::format("<h2>{}</h2>\n<p>{}</p>\n", Escaped(chapter.title), Escaped(chapter.text));
  for (const std::string& video : chapter.videos) {
    html += fmt::format("<video controls muted loop src=\"{}\"></video>\n", Escaped(video));
  }
  for (const std::string& picture : chapter.pictures) {
    html += fmt::format("<img loading=\"lazy\" alt=\"{0}\" src=\"{0}\">\n", Escaped(picture));
  }
  std::string tables;
  for (const ReportTable& table : chapter.tables) {
    if (!table.rows.empty()) tables += TableOf(table);
  }
  if (tables.empty()) return html;
  return html + "<details><summary>All figures</summary>\n" + tables + "</details>\n";
}

}  // namespace

std::string ToHtml(const std::string& title, const std::vector<std::string>& verdict,
                   const std::vector<PageChapter>& chapters) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>{0}</title>\n<style>{1}</style></head>\n<body><h1>{0}</h1>\n<ul>\n",
      Escaped(title), kStyle);
  for (const std::string& line : verdict) html += fmt::format("<li>{}</li>\n", Escaped(line));
  html += "</ul>\n";
  for (const PageChapter& chapter : chapters) html += Chapter(chapter);
  return html + "</body></html>\n";
}

}  // namespace kestrel
