// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/app/console/console_options.h"

namespace kestrel {

// Where viewers that speak Foxglove's protocol connect.
inline constexpr std::string_view kViewerPath = "/foxglove";

// The part of an HTTP request that says whose it is.
struct RequestHead {
  std::string_view target = {};                 // path and query
  std::string_view host = {};                   // as "localhost:8080"
  std::optional<std::string_view> origin = {};  // of the page that asks, where a browser says it
  std::optional<std::string_view> fetch_site = {};  // Sec-Fetch-Site
  std::optional<std::string_view> fetch_mode = {};  // Sec-Fetch-Mode
  std::string_view cookies = {};
  bool is_web_socket = false;
};

enum class Admission {
  kServed,
  kSignedIn,      // the token was in the address: a cookie takes its place
  kNoToken,       // neither cookie nor token, or a wrong one
  kWrongHost,     // a name that is not this computer's: DNS rebinding
  kForeignOrigin  // another site's page asks
};

// Who may speak to the console. A browser sends requests in its user's name for whatever page is
// open in it, so that neither the loopback address nor a firewall says who asks.
class RequestGuard {
 public:
  // 'options' are valid. 'port': the one that is served, whose cookie is told from those of other
  // servers on this computer by it.
  RequestGuard(const ConsoleOptions& options, int port);

  Admission Admit(const RequestHead& head) const;

  // What Set-Cookie says to who has signed in.
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
