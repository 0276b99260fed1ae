// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

struct PagePicture {
  std::string file;
  std::string caption;
};

// A chapter of a page for the browser. Files are named as seen from the page.
struct PageChapter {
  std::string title;
  std::string text;  // a paragraph
  std::vector<std::string> videos;
  std::vector<PagePicture> pictures;
  std::vector<ReportTable> tables;
};

// A line of the verdict, and what it is to be compared with.
struct PageVerdict {
  std::string found;
  std::string needed;
};

// Returns an HTML page that needs no other file but its videos and pictures: title, the video (if
// not empty) beside the verdict, the chapters folded away, and links to Kestrel's pages.
std::string ToHtml(const std::string& title, const std::string& video,
                   const std::vector<PageVerdict>& verdict,
                   const std::vector<PageChapter>& chapters);

}  // namespace kestrel
