// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// A chapter of a page for the browser. Files are named as seen from the page.
struct PageChapter {
  std::string title;
  std::string text;  // a paragraph
  std::vector<std::string> videos;
  std::vector<std::string> pictures;
  std::vector<ReportTable> tables;
};

// Returns an HTML page that needs no other file but its videos and pictures: title, verdict (a list
// of lines), then the chapters with their tables folded away.
std::string ToHtml(const std::string& title, const std::vector<std::string>& verdict,
                   const std::vector<PageChapter>& chapters);

}  // namespace kestrel
