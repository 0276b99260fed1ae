// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

struct PageVideo {
  std::string file;
  double still_s = 0;  // the time whose frame is shown before it is played
};

struct PagePicture {
  std::string file;
  std::string caption;
};

// A chapter of a page for the browser. Files are named as seen from the page.
struct PageChapter {
  std::string title;
  std::string text;  // a paragraph
  std::vector<PageVideo> videos;
  std::vector<PagePicture> pictures;
  std::vector<ReportTable> tables;
};

// A line of the verdict, and what it is to be compared with.
struct PageVerdict {
  std::string found;
  std::string needed;
};

// Something to do next.
struct PageStep {
  std::string text;
  std::string command;  // that does it; empty: none
  std::string file;     // to read; empty: none
};

// Returns an HTML page that needs no other file but its videos and pictures: title, the video (if
// there is one) beside the verdict, the chapters folded away, and the steps.
std::string ToHtml(const std::string& title, const std::optional<PageVideo>& video,
                   const std::vector<PageVerdict>& verdict,
                   const std::vector<PageChapter>& chapters, const std::vector<PageStep>& steps);

}  // namespace kestrel
