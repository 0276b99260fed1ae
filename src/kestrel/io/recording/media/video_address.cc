// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_address.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::array<std::string_view, 4> kSchemes = {"rtsp://", "rtsps://", "rtp://", "udp://"};
// Names of passwords in an address, and in GStreamer's pipelines.
constexpr std::array<std::string_view, 4> kQueryNames = {"password", "passwd", "pass", "pwd"};
constexpr std::array<std::string_view, 2> kPropertyNames = {"user-pw", "proxy-pw"};
constexpr int kLatency_ms = 50;  // a packet that overtakes others waits so long for them

// Returns where the pair "user:password" of an address ends, with its '@'; npos: it has none. A
// password may have '@' and '/' in it.
std::size_t EndOfUser(std::string_view text, std::size_t begin) {
  const std::string_view address = text.substr(begin, text.find_first_of(" \"'\n", begin) - begin);
  const std::size_t query = address.find('?');
  const std::size_t at = address.substr(0, query).rfind('@');
  return at == std::string_view::npos ? at : begin + at;
}

// Returns where a value in an address ends; "ADDRESS: what is wrong" ends one, too.
std::size_t EndOfQueryValue(std::string_view text, std::size_t begin) {
  const std::size_t end = std::min(text.find_first_of("& \"'\n", begin), text.size());
  return end > begin && text[end - 1] == ':' ? end - 1 : end;
}

// Returns where the value of a property in a pipeline ends: a word, or text in quotes.
std::size_t EndOfPropertyValue(std::string_view text, std::size_t begin) {
  if (begin == text.size()) return begin;
  const bool is_quoted = text[begin] == '"' || text[begin] == '\'';
  for (std::size_t i = is_quoted ? begin + 1 : begin; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (is_quoted ? text[i] == text[begin] : text[i] == ' ' || text[i] == '\n') {
      return is_quoted ? i + 1 : i;
    }
  }
  return text.size();
}

// Returns where the value after a property's name begins, behind '=' and a type; npos: nowhere.
std::size_t BeginOfPropertyValue(std::string_view text, std::size_t i) {
  i = text.find_first_not_of(' ', i);
  if (i == std::string_view::npos || text[i] != '=') return std::string_view::npos;
  i = std::min(text.find_first_not_of(' ', i + 1), text.size());
  if (i == text.size() || text[i] != '(') return i;
  const std::size_t type_end = text.find(')', i);
  return type_end == std::string_view::npos ? i : type_end + 1;
}

// Replaces the values of a name by ***.
void HideValues(std::string_view name, bool is_property, std::string* text) {
  for (std::size_t i = text->find(name); i != std::string::npos; i = text->find(name, i)) {
    const char before = i > 0 ? (*text)[i - 1] : ' ';
    i += name.size();
    if (std::isalnum(static_cast<unsigned char>(before)) || before == '-') continue;
    const bool is_assigned = i < text->size() && (*text)[i] == '=';
    const std::size_t begin = is_property   ? BeginOfPropertyValue(*text, i)
                              : is_assigned ? i + 1
                                            : std::string::npos;
    if (begin == std::string::npos) continue;
    const std::size_t end =
        is_property ? EndOfPropertyValue(*text, begin) : EndOfQueryValue(*text, begin);
    if (end > begin) text->replace(begin, end - begin, "***");
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
  for (const std::string_view name : kQueryNames) HideValues(name, false, &text);
  for (const std::string_view name : kPropertyNames) HideValues(name, true, &text);
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
