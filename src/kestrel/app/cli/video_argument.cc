// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/video_argument.h"

#include <string_view>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

VideoServerOptions ParseVideoUrl(const std::string& url, const ConsoleOptions& console) {
  constexpr std::string_view kScheme = "rtsp://";
  const bool is_rtsp = url.starts_with(kScheme);
  const std::size_t slash = is_rtsp ? url.find('/', kScheme.size()) : url.npos;
  if (slash == url.npos || slash + 1 == url.size()) {
    throw InputError(fmt::format(
        "--video '{}': expected rtsp://ADDRESS:PORT/PATH, as rtsp://127.0.0.1:8554/kestrel", url));
  }
  const std::string place = url.substr(kScheme.size(), slash - kScheme.size());
  const ConsoleOptions access = WithToken(WithAddress(console, place, "--video"));
  return {.address = access.address,
          .port = access.port,
          .path = url.substr(slash + 1),
          .password = access.IsLoopback() ? "" : access.token};
}

std::vector<std::string> VideoUrls(const VideoServerOptions& options, int port) {
  const std::string user = options.password.empty() ? "" : "kestrel:" + options.password + "@";
  const bool is_everywhere = options.address == "0.0.0.0" || options.address == "::";
  std::vector<std::string> hosts = {is_everywhere ? "localhost" : options.address};
  if (hosts[0].find(':') != std::string::npos) hosts[0] = "[" + hosts[0] + "]";
  if (is_everywhere) {
    for (const std::string& address : OwnAddresses()) hosts.push_back(address);
  }
  std::vector<std::string> urls;
  for (const std::string& host : hosts) {
    urls.push_back(fmt::format("rtsp://{}{}:{}/{}", user, host, port, options.path));
  }
  return urls;
}

}  // namespace kestrel
