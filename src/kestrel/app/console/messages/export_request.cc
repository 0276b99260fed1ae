// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/export_request.h"

#include <algorithm>

namespace kestrel {
namespace {

std::optional<std::size_t> NumberIn(std::string_view digits) {
  constexpr std::size_t kMaxDigits = 9;
  const bool is_number =
      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!is_number || digits.empty() || digits.size() > kMaxDigits) return std::nullopt;
  std::size_t number = 0;
  for (const char digit : digits) number = 10 * number + static_cast<std::size_t>(digit - '0');
  return number;
}

// The part of the text between 'begin' and 'end'; nothing when the text does not have both.
std::optional<std::string_view> Between(std::string_view begin, std::string_view text,
                                        std::string_view end) {
  if (!text.starts_with(begin) || !text.ends_with(end)) return std::nullopt;
  if (text.size() < begin.size() + end.size()) return std::nullopt;
  return text.substr(begin.size(), text.size() - begin.size() - end.size());
}

std::optional<std::size_t> NumberBetween(std::string_view begin, std::string_view text,
                                         std::string_view end) {
  const auto digits = Between(begin, text, end);
  return digits ? NumberIn(*digits) : std::nullopt;
}

// A clip's two numbers, as "12-80".
std::optional<ExportRequest> ClipBetween(std::string_view begin, std::string_view text,
                                         ExportRequest::Kind kind) {
  const auto numbers = Between(begin, text, ".mp4");
  if (!numbers) return std::nullopt;
  const std::size_t dash = numbers->find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto first = NumberIn(numbers->substr(0, dash));
  const auto last = NumberIn(numbers->substr(dash + 1));
  if (!first || !last || *last < *first) return std::nullopt;
  return ExportRequest{kind, *first, *last};
}

}  // namespace

bool IsOfColors(const ExportRequest& request) {
  return request.kind == ExportRequest::Kind::kPicture ||
         request.kind == ExportRequest::Kind::kLabels;
}

bool IsClip(const ExportRequest& request) {
  return request.kind == ExportRequest::Kind::kClip ||
         request.kind == ExportRequest::Kind::kOverlaysClip;
}

std::optional<ExportRequest> ParseExportPath(std::string_view path) {
  if (const auto clip = ClipBetween("/export/clip-", path, ExportRequest::Kind::kClip)) {
    return clip;
  }
  if (const auto clip =
          ClipBetween("/export/overlays-", path, ExportRequest::Kind::kOverlaysClip)) {
    return clip;
  }
  if (const auto frame = NumberBetween("/export/frame-", path, ".png")) {
    return ExportRequest{ExportRequest::Kind::kFrame, *frame};
  }
  if (const auto frame = NumberBetween("/export/overlays-", path, ".png")) {
    return ExportRequest{ExportRequest::Kind::kOverlays, *frame};
  }
  if (const auto frame = NumberBetween("/export/picture-", path, ".jpg")) {
    return ExportRequest{ExportRequest::Kind::kPicture, *frame};
  }
  if (const auto frame = NumberBetween("/export/labels-", path, ".bin")) {
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
