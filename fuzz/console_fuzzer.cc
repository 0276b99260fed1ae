// SPDX-License-Identifier: BSD-3-Clause
// For any input from a browser's socket: the parser of its messages does not throw, and its results
// are numbers that the program can use; a path gives numbers only; a viewer's requests get it no
// more than it may have; the guard admits nobody without the token.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kestrel/app/console/messages/client_message.h"
#include "kestrel/app/console/messages/export_request.h"
#include "kestrel/app/web_server/request_guard.h"
#include "kestrel/app/web_server/viewer_flow.h"
#include "kestrel/app/web_server/viewer_request.h"

namespace {

using kestrel::Admission;
using kestrel::RequestGuard;

constexpr char kToken[] = "0123456789abcdef";

const RequestGuard& Guard() {
  static const RequestGuard guard = [] {
    kestrel::ConsoleOptions options;
    options.token = kToken;
    return RequestGuard(options, 8080);
  }();
  return guard;
}

void Require(bool condition) {
  if (!condition) std::abort();
}

void ReadMessage(std::string_view text) {
  const auto message = kestrel::ParseClientMessage(text);
  if (!message) return;
  if (const auto* command = std::get_if<kestrel::ConsoleCommand>(&*message)) {
    Require(std::isfinite(command->value));
    Require(command->settings.size() <= 32);
  }
  if (const auto* request = std::get_if<kestrel::ColorRequest>(&*message)) {
    Require(request->color.size() <= 64 && request->stroke.color.size() <= 64);
    const bool is_mark = request->action == kestrel::ColorAction::kMark;
    Require(!is_mark || request->stroke.Validate().empty());
  }
}

void ReadExportPath(std::string_view text) {
  const auto wanted = kestrel::ParseExportPath(text);
  if (!wanted) return;
  Require(wanted->number < 1'000'000'000);
  Require(text.starts_with("/export/") && text.find('.') == text.rfind('.'));
}

const std::vector<kestrel::LiveChannel>& Channels() {
  static const std::vector<kestrel::LiveChannel> channels = {{.topic = "/image", .is_image = true},
                                                             {.topic = "/result"}};
  return channels;
}

void Subscribe(std::string_view text) {
  constexpr std::size_t kCapacity = 4;
  kestrel::ViewerFlow flow(&Channels(), kCapacity);
  for (const auto& request : {kestrel::ParseViewerText(text), kestrel::ParseViewerBytes(text)}) {
    if (request) flow.Take(*request);
  }
  Require(flow.wanted() < 4);
  const auto content = std::make_shared<const std::string>("x");
  for (std::size_t channel = 0; channel < 2; ++channel) flow.Offer({channel, {}, content});
  std::size_t sent = 0;
  while (flow.Pop()) ++sent;
  Require(sent <= kCapacity + 1);
}

// Host, origin, cookies and target, one line each.
void QueryGuard(std::string_view text, bool is_web_socket) {
  std::string_view lines[4];
  for (std::string_view& line : lines) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const Admission admission = Guard().Admit({.target = lines[3],
                                             .host = lines[0],
                                             .origin = lines[1],
                                             .cookies = lines[2],
                                             .is_web_socket = is_web_socket});
  const bool knows_token =
      lines[2].find(kToken) != lines[2].npos || lines[3].find(kToken) != lines[3].npos;
  const bool is_let_in = admission == Admission::kServed || admission == Admission::kSignedIn;
  Require(!is_let_in || (knows_token && lines[1].ends_with(lines[0])));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  ReadMessage(text);
  ReadExportPath(text);
  Subscribe(text);
  QueryGuard(text, /*is_web_socket=*/false);
  QueryGuard(text, /*is_web_socket=*/true);
  return 0;
}
