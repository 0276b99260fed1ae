// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/request_guard.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr std::string_view kTokenQuery = "?token=";

// Compares in a time that does not reveal how many characters are right.
bool IsSame(std::string_view given, std::string_view secret) {
  if (given.size() != secret.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(secret[i]);
  }
  return difference == 0;
}

// "localhost:8080" -> "localhost", "[::1]:8080" -> "::1"; empty when it is neither.
std::string NameOf(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return std::string(end == host.npos ? "" : host.substr(1, end - 1));
  }
  std::string name(host.substr(0, host.find(':')));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return name;
}

std::string_view PathOf(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view WithoutSpaces(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

RequestGuard::RequestGuard(const ConsoleOptions& options, int port)
    : is_loopback_(options.IsLoopback()),
      token_(options.token),
      cookie_name_(fmt::format("kestrel_{}", port)),
      host_names_(options.HostNames()),
      viewer_origins_(options.ViewerOrigins()) {}

Admission RequestGuard::Admit(const RequestHead& head) const {
  if (!IsOwnHost(head.host)) return Admission::kWrongHost;
  if (head.is_web_socket && PathOf(head.target) == kViewerPath) return AdmitViewer(head);
  if (IsForeign(head)) return Admission::kForeignOrigin;
  if (token_.empty() || HasCookie(head.cookies)) return Admission::kServed;
  const bool has_token = !head.is_web_socket && PathOf(head.target) == "/" && HasToken(head.target);
  return has_token ? Admission::kSignedIn : Admission::kNoToken;
}

// A viewer can only look. A client without an origin is not a page, as browsers always send it with
// a WebSocket. Requests of other sites' pages come without the cookie; they have the token in the
// address.
Admission RequestGuard::AdmitViewer(const RequestHead& head) const {
  const bool is_listed = !head.origin || std::find(viewer_origins_.begin(), viewer_origins_.end(),
                                                   *head.origin) != viewer_origins_.end();
  if (!is_listed && IsForeign(head)) return Admission::kForeignOrigin;
  const bool knows_token = token_.empty() || HasToken(head.target) || HasCookie(head.cookies);
  return knows_token ? Admission::kServed : Admission::kNoToken;
}

bool RequestGuard::HasToken(std::string_view target) const {
  const std::string_view query = target.substr(PathOf(target).size());
  return query.starts_with(kTokenQuery) && IsSame(query.substr(kTokenQuery.size()), token_);
}

// The port is not compared, as it differs through a tunnel. Addresses cannot be rebound, but names
// can.
bool RequestGuard::IsOwnHost(std::string_view host) const {
  const std::string name = NameOf(host);
  if (name == "localhost") return true;
  if (std::find(host_names_.begin(), host_names_.end(), name) != host_names_.end()) return true;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(name, error);
  return !error && (!is_loopback_ || address.is_loopback());
}

bool RequestGuard::IsForeign(const RequestHead& head) const {
  // A link on another site may lead here: the result is this site's page.
  const bool is_navigation = head.fetch_mode == "navigate" && !head.is_web_socket;
  if (head.fetch_site && *head.fetch_site != "same-origin" && *head.fetch_site != "none" &&
      !is_navigation) {
    return true;
  }
  if (!head.origin) return head.is_web_socket;  // browsers send it with every WebSocket
  return *head.origin != fmt::format("http://{}", head.host) &&
         *head.origin != fmt::format("https://{}", head.host);
}

bool RequestGuard::HasCookie(std::string_view cookies) const {
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    const std::string_view cookie = WithoutSpaces(cookies.substr(0, end));
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    const std::size_t equal = cookie.find('=');
    if (equal == cookie.npos || cookie.substr(0, equal) != cookie_name_) continue;
    if (IsSame(cookie.substr(equal + 1), token_)) return true;
  }
  return false;
}

std::string RequestGuard::CookieHeader() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name_, token_);
}

}  // namespace kestrel
