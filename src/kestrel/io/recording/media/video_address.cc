// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_address.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::array<std::string_view, 4> kSchemes = {"rtsp://", "rtsps://", "rtp://", "udp://"};
// Names of passwords in a query and in GStreamer's pipelines.
constexpr std::array<std::string_view, 6> kPasswordNames = {
    "password=", "passwd=", "pass=", "pwd=", "user-pw=", "proxy-pw="};
constexpr int kLatency_ms = 50;  // a packet that overtakes others waits so long for them

// Returns where the pair "user:password" of an address ends, with its '@'; npos: it has none. A
// password may have '@' and '/' in it.
std::size_t EndOfUser(std::string_view text, std::size_t begin) {
  const std::string_view address = text.substr(begin, text.find_first_of(" \"'\n", begin) - begin);
  const std::size_t query = address.find('?');
  const std::size_t at = address.substr(0, query).rfind('@');
  return at == std::string_view::npos ? at : begin + at;
}

void HideValues(std::string_view name, std::string* text) {
  for (std::size_t i = text->find(name); i != std::string::npos; i = text->find(name, i)) {
    i += name.size();
    const bool is_quoted = i < text->size() && ((*text)[i] == '"' || (*text)[i] == '\'');
    const std::string_view ends = is_quoted ? "\"'" : "& \"'\n";
    if (is_quoted) ++i;
    std::size_t end = std::min(text->find_first_of(ends, i), text->size());
    if (end > i && (*text)[end - 1] == ':') --end;  // "ADDRESS: what is wrong"
    if (end > i) text->replace(i, end - i, "***");
  }
}

}  // namespace

bool IsVideoAddress(std::string_view camera) {
  return std::ranges::any_of(kSchemes, [&](auto scheme) { return camera.starts_with(scheme); });
}

bool IsNetworkVideo(std::string_view camera) {
  return IsVideoAddress(camera) || camera.starts_with("rtspsrc ") || camera.starts_with("udpsrc ");
}

std::string WithoutPassword(std::string text) {
  constexpr std::string_view kBegin = "://";
  for (std::size_t i = text.find(kBegin); i != std::string::npos; i = text.find(kBegin, i)) {
    i += kBegin.size();
    const std::size_t end = EndOfUser(text, i);
    if (end != std::string::npos) text.replace(i, end - i, "***");
  }
  for (const std::string_view name : kPasswordNames) HideValues(name, &text);
  return text;
}

std::string NetworkVideoText(const std::string& address) {
  if (address.find_first_of(" \"") != std::string::npos) {
    throw InputError(WithoutPassword(address) + ": expected %20 and %22 for a blank and a quote");
  }
  if (address.starts_with("rtsp")) {
    return fmt::format(
        "rtspsrc name=network location=\"{}\" latency={} drop-on-latency=true buffer-mode=none ! "
        "application/x-rtp,media=video",
        address, kLatency_ms);
  }
  const std::string place = address.substr(address.find("://"));
  return fmt::format(
      "udpsrc uri=\"udp{}\" caps=\"application/x-rtp,media=video,clock-rate=90000,"
      "encoding-name=H264\" ! rtpjitterbuffer name=network latency={} drop-on-latency=true "
      "mode=none do-lost=true",
      place, kLatency_ms);
}

}  // namespace kestrel
