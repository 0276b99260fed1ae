// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/app/web_server/console_options.h"

namespace kestrel {

// Path to which viewers connect that speak Foxglove's protocol.
inline constexpr std::string_view kViewerPath = "/foxglove";

// The parts of an HTTP request that identify its sender.
struct RequestHead {
  std::string_view target = {};                     // path and query
  std::string_view host = {};                       // as "localhost:8080"
  std::optional<std::string_view> origin = {};      // where the page is from, if sent
  std::optional<std::string_view> fetch_site = {};  // Sec-Fetch-Site
  std::optional<std::string_view> fetch_mode = {};  // Sec-Fetch-Mode
  std::string_view cookies = {};
  bool is_web_socket = false;
};

enum class Admission {
  kServed,
  kSignedIn,      // the token was in the address; a cookie replaces it
  kNoToken,       // neither cookie nor token, or a wrong one
  kWrongHost,     // a host name that is not this computer's: DNS rebinding
  kForeignOrigin  // the request comes from a page of another site
};

// Decides who may use the console. A browser sends requests on behalf of any page that is open in
// it; therefore neither the loopback address nor a firewall identifies the sender.
class RequestGuard {
 public:
  // 'options' are valid. 'port': port of this server. The cookie's name contains it, so that the
  // cookies of several servers on this computer differ.
  RequestGuard(const ConsoleOptions& options, int port);

  Admission Admit(const RequestHead& head) const;

  // Returns the value of Set-Cookie for a browser that has signed in.
  std::string CookieHeader() const;

 private:
  bool IsOwnHost(std::string_view host) const;
  bool IsForeign(const RequestHead& head) const;
  Admission AdmitViewer(const RequestHead& head) const;
  bool HasToken(std::string_view target) const;
  bool HasCookie(std::string_view cookies) const;

  bool is_loopback_;
  std::string token_;
  std::string cookie_name_;
  std::vector<std::string> host_names_, viewer_origins_;
};

}  // namespace kestrel
