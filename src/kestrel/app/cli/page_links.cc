// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/page_links.h"

#include <memory>
#include <qrencode.h>
#include <unistd.h>

#include <fmt/format.h>

namespace kestrel {

void PrintLinks(const std::vector<std::string>& urls) {
  for (const std::string& url : urls) fmt::print(stderr, "console: {}\n", url);
  const std::string& link = urls.size() > 1 ? urls[1] : urls[0];
  const bool is_local = link.starts_with("http://127.") || link.starts_with("http://[::1]") ||
                        link.starts_with("http://localhost:");
  if (!is_local && isatty(STDERR_FILENO) != 0) fmt::print(stderr, "{}", QrLines(link));
}

std::string QrLines(const std::string& text) {
  constexpr int kMargin = 2;  // white modules around
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_L, QR_MODE_8, 1), QRcode_free);
  if (!code) return "";
  const auto is_white = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < code->width && y < code->width;
    return !is_inside || (code->data[y * code->width + x] & 1) == 0;
  };
  static constexpr const char* kBlocks[2][2] = {{" ", "▄"}, {"▀", "█"}};  // by upper, lower
  std::string lines;
  for (int y = -kMargin; y < code->width + kMargin; y += 2) {
    lines += "\x1b[97;40m";
    for (int x = -kMargin; x < code->width + kMargin; ++x) {
      lines += kBlocks[is_white(x, y)][is_white(x, y + 1)];
    }
    lines += "\x1b[0m\n";
  }
  return lines;
}

}  // namespace kestrel
