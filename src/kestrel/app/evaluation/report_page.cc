// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/report_page.h"

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr char kStyle[] =
    ":root{color-scheme:light dark;--text:#1c2024;--page:#fff;--line:#ccd;--good:#e8f6f1;"
    "--quiet:#56606a;--link:#0b57a4}"
    "@media(prefers-color-scheme:dark){:root{--text:#e6e8ea;--page:#15181b;--line:#3a4148;"
    "--good:#17302a;--quiet:#a3adb6;--link:#7db7f5}}"
    "body{max-width:75rem;margin:1rem auto;padding:0 1rem;font:1rem/1.5 system-ui,sans-serif;"
    "color:var(--text);background:var(--page)}"
    "h1{font-size:1.5rem;margin:.5rem 0}h2{font-size:1.15rem}a,summary{color:var(--link)}"
    "li{margin:.3rem 0}code{overflow-wrap:anywhere}"
    ".first{display:grid;grid-template-columns:3fr 2fr;gap:1.5rem;align-items:start}"
    "@media(max-width:50rem){.first{grid-template-columns:1fr}}"
    "dl{margin:0;padding:.5rem 1rem;border-left:.3rem solid #009e73;background:var(--good)}"
    "dt{font-weight:600;margin-top:.5rem}dd,figcaption{margin:0;color:var(--quiet);font-size:.9rem}"
    "video,img{width:100%;height:auto}img{background:#fff}figure{margin:1rem 0}"
    "summary{cursor:pointer;font-size:1.15rem;padding:.6rem 0;border-top:1px solid var(--line)}"
    "details details summary{font-size:1rem;border:0}"
    ".plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(30rem,100%),1fr));"
    "gap:1rem}"
    "table{border-collapse:collapse;font-size:.85rem;margin-bottom:1rem}"
    "td,th{border:1px solid var(--line);padding:.2rem .5rem;text-align:right}"
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

std::string Video(const PageVideo& video) {
  return fmt::format(
      "<video controls muted loop playsinline preload=\"metadata\" src=\"{}#t={:g}\"></video>\n",
      Escaped(video.file), video.still_s);
}

std::string Picture(const PagePicture& picture) {
  return fmt::format(
      "<figure><img loading=\"lazy\" alt=\"{1}\" "
      "src=\"{0}\"><figcaption>{1}</figcaption></figure>\n",
      Escaped(picture.file), Escaped(picture.caption));
}

std::string Folded(const std::string& title, const std::string& content) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", Escaped(title), content);
}

std::string Chapter(const PageChapter& chapter) {
  std::string html = fmt::format("<p>{}</p>\n", Escaped(chapter.text));
  for (const PageVideo& video : chapter.videos) html += Video(video);
  html += "<div class=\"plots\">\n";
  for (const PagePicture& picture : chapter.pictures) html += Picture(picture);
  html += "</div>\n";
  std::string tables;
  for (const ReportTable& table : chapter.tables) {
    if (!table.rows.empty()) tables += TableOf(table);
  }
  if (!tables.empty()) html += Folded("All figures", tables);
  return Folded(chapter.title, html);
}

std::string Steps(const std::vector<PageStep>& steps) {
  std::string html = "<h2>Next</h2>\n<ol>\n";
  for (const PageStep& step : steps) {
    std::string text = Escaped(step.text);
    if (!step.file.empty()) {
      text = fmt::format("<a href=\"{}\">{}</a>", Escaped(step.file), text);
    }
    if (!step.command.empty()) text += fmt::format(": <code>{}</code>", Escaped(step.command));
    html += fmt::format("<li>{}</li>\n", text);
  }
  return html + "</ol>\n";
}

}  // namespace

std::string ToHtml(const std::string& title, const std::optional<PageVideo>& video,
                   const std::vector<PageVerdict>& verdict,
                   const std::vector<PageChapter>& chapters, const std::vector<PageStep>& steps) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>{0}</title>\n<style>{1}</style></head>\n<body><h1>{0}</h1>\n"
      "<div class=\"first\">\n<div>{2}</div>\n<dl>\n",
      Escaped(title), kStyle, video ? Video(*video) : "");
  for (const PageVerdict& line : verdict) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", Escaped(line.found), Escaped(line.needed));
  }
  html += "</dl></div>\n";
  for (const PageChapter& chapter : chapters) html += Chapter(chapter);
  return html + Steps(steps) + "</body></html>\n";
}

}  // namespace kestrel
