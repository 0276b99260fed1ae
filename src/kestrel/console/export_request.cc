// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/export_request.h"

#include <algorithm>

namespace kestrel {
namespace {

// The number between a beginning and an end of the text; nothing when it is another text.
std::optional<std::size_t> NumberBetween(std::string_view begin, std::string_view text,
                                         std::string_view end) {
  constexpr std::size_t kMaxDigits = 9;
  if (!text.starts_with(begin) || !text.ends_with(end)) return std::nullopt;
  if (text.size() <= begin.size() + end.size()) return std::nullopt;
  const std::string_view digits =
      text.substr(begin.size(), text.size() - begin.size() - end.size());
  const bool is_number =
      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!is_number || digits.size() > kMaxDigits) return std::nullopt;
  std::size_t number = 0;
  for (const char digit : digits) number = 10 * number + static_cast<std::size_t>(digit - '0');
  return number;
}

}  // namespace

bool IsOfColors(const ExportRequest& request) {
  return request.kind == ExportRequest::Kind::kPicture ||
         request.kind == ExportRequest::Kind::kLabels;
}

std::optional<ExportRequest> ParseExportPath(std::string_view path) {
  if (const auto frame = NumberBetween("/export/frame-", path, ".png")) {
    return ExportRequest{ExportRequest::Kind::kFrame, *frame};
  }
  if (const auto frame = NumberBetween("/export/overlays-", path, ".png")) {
    return ExportRequest{ExportRequest::Kind::kOverlays, *frame};
  }
  if (const auto frame = NumberBetween("/export/picture-", path, ".jpg")) {
    return ExportRequest{ExportRequest::Kind::kPicture, *frame};
  }
  if (const auto frame = NumberBetween("/export/labels-", path, ".png")) {
    return ExportRequest{ExportRequest::Kind::kLabels, *frame};
  }
  if (const auto calibration = NumberBetween("/export/calibration-", path, ".yaml")) {
    return ExportRequest{ExportRequest::Kind::kCalibration, *calibration};
  }
  const auto run = NumberBetween("/export/detections-", path, ".csv");
  if (run && (*run == 1 || *run == 2)) {
    return ExportRequest{ExportRequest::Kind::kDetections, *run};
  }
  return std::nullopt;
}

}  // namespace kestrel
