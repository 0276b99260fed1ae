// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/request_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr char kToken[] = "0123456789abcdef";

ConsoleOptions OptionsAt(const std::string& address, const std::string& token = "") {
  ConsoleOptions options;
  options.address = address;
  options.token = token;
  return options;
}

RequestHead Page(std::string_view host) { return {.target = "/", .host = host}; }

RequestHead Socket(std::string_view host, std::optional<std::string_view> origin) {
  return {.target = "/live", .host = host, .origin = origin, .is_web_socket = true};
}

TEST(RequestGuardTest, LoopbackServesLocalNamesOnly) {
  const RequestGuard guard(OptionsAt("127.0.0.1"), 8080);
  for (const char* host : {"localhost", "LocalHost:9000", "127.0.0.1:8080", "[::1]:8080"}) {
    EXPECT_EQ(guard.Admit(Page(host)), Admission::kServed) << host;
  }
  for (const char* host :
       {"", "evil.example", "localhost.evil.example:8080", "10.0.0.5", "2130706433", "[::1", "[]",
        "127.0.0.1.nip.io", "localhost@evil.example"}) {
    EXPECT_EQ(guard.Admit(Page(host)), Admission::kWrongHost) << host;
  }
}

TEST(RequestGuardTest, NetworkServesAddressesAndConfiguredNames) {
  ConsoleOptions options = OptionsAt("0.0.0.0", kToken);
  options.host_names = "Kestrel.local, uav";
  const RequestGuard guard(options, 8080);
  for (const char* host : {"10.0.0.5:8080", "kestrel.LOCAL:8080", "uav"}) {
    EXPECT_EQ(guard.Admit(Page(host)), Admission::kNoToken) << host;
  }
  EXPECT_EQ(guard.Admit(Page("evil.example")), Admission::kWrongHost);
}

TEST(RequestGuardTest, WebSocketRequiresOwnOrigin) {
  const RequestGuard guard(OptionsAt("127.0.0.1"), 8080);
  EXPECT_EQ(guard.Admit(Socket("localhost:8080", "http://localhost:8080")), Admission::kServed);
  EXPECT_EQ(guard.Admit(Socket("localhost:8080", std::nullopt)), Admission::kForeignOrigin);
  for (const char* origin : {"http://evil.example", "null", "http://localhost:8081", "",
                             "http://localhost:8080.evil.example", "ftp://localhost:8080"}) {
    EXPECT_EQ(guard.Admit(Socket("localhost:8080", origin)), Admission::kForeignOrigin) << origin;
  }
}

TEST(RequestGuardTest, OtherSitesMayLinkOnly) {
  const RequestGuard guard(OptionsAt("127.0.0.1"), 8080);
  RequestHead head = Page("localhost");
  head.fetch_site = "cross-site";
  EXPECT_EQ(guard.Admit(head), Admission::kForeignOrigin);
  head.fetch_mode = "navigate";
  EXPECT_EQ(guard.Admit(head), Admission::kServed);
  head.is_web_socket = true;
  EXPECT_EQ(guard.Admit(head), Admission::kForeignOrigin);
}

TEST(RequestGuardTest, TokenBecomesCookie) {
  const RequestGuard guard(OptionsAt("10.0.0.5", kToken), 8080);
  RequestHead head = Page("10.0.0.5:8080");
  EXPECT_EQ(guard.Admit(head), Admission::kNoToken);
  head.target = "/?token=0123456789abcdef";
  EXPECT_EQ(guard.Admit(head), Admission::kSignedIn);
  for (const char* target : {"/?token=", "/?token=0123456789abcdee", "/?token=0123456789abcdef0",
                             "/?token=0123456789abcde", "/x?token=0123456789abcdef"}) {
    head.target = target;
    EXPECT_EQ(guard.Admit(head), Admission::kNoToken) << target;
  }
  EXPECT_EQ(guard.CookieHeader(),
            "kestrel_8080=0123456789abcdef; Path=/; HttpOnly; SameSite=Strict");
}

TEST(RequestGuardTest, ReadsItsCookieAmongOthers) {
  const RequestGuard guard(OptionsAt("10.0.0.5", kToken), 8080);
  RequestHead head = Socket("10.0.0.5:8080", "http://10.0.0.5:8080");
  for (const char* cookies :
       {"kestrel_8080=0123456789abcdef", "a=b; kestrel_8080=0123456789abcdef ",
        "kestrel_8080=old;kestrel_8080=0123456789abcdef"}) {
    head.cookies = cookies;
    EXPECT_EQ(guard.Admit(head), Admission::kServed) << cookies;
  }
  for (const char* cookies : {"", "kestrel_8080=", "kestrel_8081=0123456789abcdef", ";;=;",
                              "kestrel_8080=0123456789abcdee", "0123456789abcdef"}) {
    head.cookies = cookies;
    EXPECT_EQ(guard.Admit(head), Admission::kNoToken) << cookies;
  }
}

TEST(ConsoleOptionsTest, ReportsFaultsWithoutToken) {
  ConsoleOptions options = OptionsAt("nowhere", "geheim");
  EXPECT_THAT(ViolationsOf(options),
              testing::ElementsAre("address is 'nowhere', expected an IP address",
                                   "token is not 16 to 128 of A-Z a-z 0-9 - _"));
  options.port = 70000;
  EXPECT_THAT(ViolationsOf(options), testing::ElementsAre("port is 70000, expected 0 to 65535"));
  EXPECT_THAT(ViolationsOf(OptionsAt("::1")), testing::IsEmpty());
  EXPECT_THAT(ViolationsOf(OptionsAt("10.0.0.5", "0123456789abcdef")), testing::IsEmpty());
}

TEST(ConsoleOptionsTest, AddressOpenToOthersGetsToken) {
  EXPECT_EQ(WithToken(OptionsAt("127.0.0.1")).token, "");
  const ConsoleOptions open = WithToken(OptionsAt("0.0.0.0"));
  EXPECT_EQ(open.token.size(), 32u);
  EXPECT_THAT(ViolationsOf(open), testing::IsEmpty());
  EXPECT_NE(WithToken(OptionsAt("0.0.0.0")).token, open.token);
  EXPECT_EQ(WithToken(OptionsAt("0.0.0.0", "0123456789abcdef")).token, "0123456789abcdef");
}

TEST(RequestGuardTest, AcceptsOwnHostName) {
  const RequestGuard guard(OptionsAt("0.0.0.0", "0123456789abcdef"), 8080);
  for (const std::string& host : {OwnHostName(), OwnHostName() + ".local:8080"}) {
    EXPECT_NE(guard.Admit({.target = "/", .host = host}), Admission::kWrongHost) << host;
  }
  EXPECT_EQ(guard.Admit({.target = "/", .host = OwnHostName() + ".example"}),
            Admission::kWrongHost);
}

TEST(ConsoleOptionsTest, RefusesViewerOriginsWithPathsAndWildcards) {
  ConsoleOptions options = OptionsAt("127.0.0.1", kToken);
  options.viewer_origins = "https://app.foxglove.dev, http://localhost:8081, file://";
  EXPECT_THAT(ViolationsOf(options), testing::IsEmpty());
  EXPECT_EQ(options.ViewerOrigins()[1], "http://localhost:8081");
  options.token.clear();
  for (const char* origin : {"file://", "null", "*", "https://*", "app.foxglove.dev", "https://",
                             "https://app.foxglove.dev/", "://x"}) {
    options.viewer_origins = origin;
    EXPECT_EQ(ViolationsOf(options).size(), 1u) << origin;
  }
}

TEST(ConsoleOptionsTest, AcceptsAddressWithPort) {
  const auto read = [](const std::string& text) { return WithAddress({}, text, "--console"); };
  EXPECT_EQ(read("10.0.0.5:80").address, "10.0.0.5");
  EXPECT_EQ(read("10.0.0.5:80").port, 80);
  EXPECT_EQ(read("[::1]:0").address, "::1");
  for (const char* text : {"", ":", "8080", ":8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x",
                           "127.0.0.1:-1", "127.0.0.1:65536", "localhost:8080", "::1:80", "::1",
                           "[::1]", "[127.0.0.1]:80", "[::1:80"}) {
    EXPECT_THROW(read(text), InputError) << text;
  }
}

}  // namespace
}  // namespace kestrel
