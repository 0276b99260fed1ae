// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/web_server.h"

#include <array>
#include <atomic>
#include <random>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/console_page.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;
namespace http = boost::beast::http;

constexpr std::array<WebAsset, 3> kAssets{{
    {"/index.html", "text/html; charset=utf-8", "<p>page", false},
    {"/assets/app.1234.js", "text/javascript; charset=utf-8", "zipped", true},
    {"/icon.svg", "image/svg+xml", "<svg/>", false},
}};

ConsoleFrame SomeFrame(int width = 64) {
  ConsoleFrame frame;
  frame.captured = Now();
  frame.image = cv::Mat(width * 3 / 4, width, CV_8UC1, cv::Scalar(99));
  return frame;
}

// Noise, as JPEG cannot make it small.
cv::Mat NoiseImage(int width, int height) {
  cv::Mat image(height, width, CV_8UC1);
  std::mt19937 random(1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.at<uchar>(y, x) = static_cast<uchar>(random());
  }
  return image;
}

class WebServerTest : public testing::Test {
 protected:
  ConsoleFeed feed_{{.title = "test",
                     .is_live = true,
                     .series = {{"height", "m", "Height"}},
                     .layers = {OverlayLayer::kDetection},
                     .views = {},
                     .offers = {ConsoleCommandKind::kRecord}}};
};

TEST_F(WebServerTest, ServesPageWithSecurityHeaders) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  TestBrowser browser(server.port());
  const auto page = browser.Send(browser.Get("/"));
  EXPECT_EQ(page.result_int(), 200u);
  EXPECT_EQ(page.body(), "<p>page");
  EXPECT_EQ(page[http::field::content_type], "text/html; charset=utf-8");
  EXPECT_THAT(std::string(page["Content-Security-Policy"]),
              testing::AllOf(testing::HasSubstr("default-src 'self'"),
                             testing::HasSubstr("frame-ancestors 'none'")));
  EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
  EXPECT_EQ(page["Referrer-Policy"], "no-referrer");
  EXPECT_EQ(page[http::field::cache_control], "no-store");
  EXPECT_EQ(page.count("Access-Control-Allow-Origin"), 0u);
  // The same connection serves the next request.
  auto script = browser.Get("/assets/app.1234.js");
  script.set(http::field::accept_encoding, "gzip, br");
  const auto answer = browser.Send(script);
  EXPECT_EQ(answer[http::field::content_encoding], "gzip");
  EXPECT_THAT(std::string(answer[http::field::cache_control]), testing::HasSubstr("immutable"));
}

TEST_F(WebServerTest, ServesBuiltInPage) {
  const WebServer server = ServeConsole(AnyPort(), &feed_);
  TestBrowser browser(server.port());
  auto request = browser.Get("/");
  request.set(http::field::accept_encoding, "gzip");
  EXPECT_EQ(browser.Send(request).result_int(), 200u);
}

TEST_F(WebServerTest, UnpacksPageForClientsWithoutGzip) {
  const WebServer server = ServeConsole(AnyPort(), &feed_);
  TestBrowser browser(server.port());
  const auto page = browser.Send(browser.Get("/"));
  EXPECT_EQ(page.result_int(), 200u);
  EXPECT_EQ(page.count(http::field::content_encoding), 0u);
  EXPECT_THAT(page.body(), testing::HasSubstr("<title>"));
}

TEST_F(WebServerTest, RefusesOtherPaths) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  for (const char* target :
       {"/etc/passwd", "/../etc/passwd", "/assets/../index.html", "/%2e%2e/etc/passwd", "/assets",
        "//index.html", "/index.html/", "/index.html?x", "/live", "*", "http://evil.example/"}) {
    TestBrowser browser(server.port());
    EXPECT_EQ(browser.Send(browser.Get(target)).result_int(), 404u) << target;
  }
  for (const auto verb : {http::verb::post, http::verb::put, http::verb::delete_,
                          http::verb::options, http::verb::trace}) {
    TestBrowser browser(server.port());
    auto request = browser.Get("/");
    request.method(verb);
    EXPECT_EQ(browser.Send(request).result_int(), 405u) << verb;
  }
}

TEST_F(WebServerTest, RefusesWrongHostsAndOrigins) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  for (const char* host : {"evil.example", "evil.example:8080", "192.168.1.7", ""}) {
    TestBrowser browser(server.port());
    auto request = browser.Get("/");
    request.set(http::field::host, host);
    EXPECT_EQ(browser.Send(request).result_int(), 421u) << host;
  }
  TestBrowser twice(server.port());
  EXPECT_EQ(twice.SendBytes("GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n")
                .result_int(),
            400u);
  TestBrowser foreign(server.port());
  auto request = foreign.Get("/");
  request.set("Origin", "http://evil.example");
  EXPECT_EQ(foreign.Send(request).result_int(), 403u);
  EXPECT_FALSE(TestSocket(server.port(), "http://evil.example").is_open());
  EXPECT_FALSE(TestSocket(server.port(), "").is_open());
  EXPECT_TRUE(TestSocket(server.port()).is_open());
}

TEST_F(WebServerTest, ServesNothingWithoutToken) {
  const WebServer server = ServeConsole(AnyPort(kSecret), &feed_, kAssets);
  EXPECT_THAT(server.urls().front(), testing::EndsWith("/?token=0123456789abcdef"));
  for (const char* target : {"/", "/index.html", "/nothing", "/?token=0123456789abcdee"}) {
    TestBrowser browser(server.port());
    const auto answer = browser.Send(browser.Get(target));
    EXPECT_EQ(answer.result_int(), 401u) << target;
    EXPECT_EQ(answer.count(http::field::set_cookie), 0u);
    EXPECT_THAT(answer.body(), testing::Not(testing::HasSubstr(kSecret)));
  }
  const std::string origin = "http://127.0.0.1:" + std::to_string(server.port());
  EXPECT_FALSE(TestSocket(server.port(), origin).is_open());
  EXPECT_FALSE(TestSocket(server.port(), origin, "kestrel=1").is_open());

  TestBrowser browser(server.port());
  const auto answer = browser.Send(browser.Get("/?token=0123456789abcdef"));
  EXPECT_EQ(answer.result_int(), 303u);
  EXPECT_EQ(answer[http::field::location], "/");
  const std::string cookie(answer[http::field::set_cookie]);
  EXPECT_THAT(cookie, testing::HasSubstr("HttpOnly; SameSite=Strict"));
  auto request = browser.Get("/");
  request.set(http::field::cookie, cookie.substr(0, cookie.find(';')));
  EXPECT_EQ(browser.Send(request).result_int(), 200u);
  EXPECT_TRUE(TestSocket(server.port(), origin, cookie.substr(0, cookie.find(';'))).is_open());
}

TEST_F(WebServerTest, RequiresTokenAtPublicAddress) {
  ConsoleOptions options = AnyPort();
  options.address = "0.0.0.0";
  const auto answer = [&] {
    const WebServer server = ServeConsole(options, &feed_, kAssets);
    TestBrowser browser(server.port());
    return browser.Send(browser.Get("/")).result_int();
  };
  EXPECT_EQ(answer(), 401u) << "a token is made where none is given";
  options.token = kSecret;
  EXPECT_EQ(answer(), 401u);
}

TEST_F(WebServerTest, ReportsPortInUse) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  ConsoleOptions options = AnyPort();
  options.port = server.port();
  try {
    const WebServer second = ServeConsole(options, &feed_, kAssets);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("console: cannot listen at 127.0.0.1 port"));
  }
}

TEST_F(WebServerTest, RefusesMalformedAndOversizeRequests) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  const std::string start = "GET / HTTP/1.1\r\nHost: localhost\r\n";
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 15),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("GET /\r\n\r\n"),
        start + "X: " + std::string(20000, 'a') + "\r\n\r\n",
        "GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n\r\n",
        start + "Content-Length: 5\r\n\r\nhello", start + "Content-Length: 99999999999\r\n\r\n",
        start + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n",
        start + "Content-Length: 1\r\nContent-Length: 2\r\n\r\n",
        std::string(
            "POST /live HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n{\"ack\":1}")}) {
    TestBrowser browser(server.port());
    const unsigned status = browser.SendBytes(bytes).result_int();
    EXPECT_TRUE(status == 400 || status == 0) << bytes.substr(0, 80) << ": " << status;
  }
  TestBrowser browser(server.port());
  EXPECT_EQ(browser.Send(browser.Get("/")).result_int(), 200u);
}

// Each request is wrong in at least one way; the other parts are drawn at random.
TEST_F(WebServerTest, RefusesThousandHostileRequests) {
  const WebServer server = ServeConsole(AnyPort(kSecret), &feed_, kAssets);
  std::mt19937 random(20);
  const auto pick = [&random](const std::vector<std::string>& from) {
    return from[random() % from.size()];
  };
  const std::string long_text(9000, 'A');
  const std::vector<std::string> targets = {"/",
                                            "/live",
                                            "/../../etc/passwd",
                                            "/..%2f..%2fetc/passwd",
                                            "/assets/%00",
                                            "/?token=",
                                            "/?token=0123456789abcdeg",
                                            "/foxglove",
                                            "/foxglove?token=0123456789abcdeg",
                                            "//evil.example/",
                                            "/index.html",
                                            "/" + long_text,
                                            "*",
                                            "\\x"};
  const std::vector<std::string> hosts = {
      "localhost",  "127.0.0.1", "evil.example", "localhost.evil.example",
      "0x7f000001", "",          long_text,      "localhost\r\nHost: localhost"};
  const std::vector<std::string> fields = {
      "",
      "Origin: http://evil.example\r\n",
      "Origin: null\r\n",
      "Cookie: kestrel=1\r\n",
      "Cookie: " + long_text + "\r\n",
      "Content-Length: 9\r\n",
      "Transfer-Encoding: chunked\r\n",
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n",
      "Sec-Fetch-Site: cross-site\r\n",
      ": \r\n",
      "X\r\n",
      "Content-Length: -1\r\n"};
  const std::vector<std::string> bodies = {"", "{\"ack\":1}", "5\r\nhello\r\n0\r\n\r\n",
                                           "\x81\x05hello"};
  for (int i = 0; i < 1000; ++i) {
    const std::string bytes = pick({"GET", "POST", "PUT", "OPTIONS", "get", "\xff"}) + " " +
                              pick(targets) + " HTTP/1.1\r\nHost: " + pick(hosts) + "\r\n" +
                              pick(fields) + pick(fields) + "\r\n" + pick(bodies);
    TestBrowser browser(server.port());
    const auto answer = browser.SendBytes(bytes);
    const unsigned status = answer.result_int();
    EXPECT_TRUE(status == 0 || (status >= 400 && status < 500)) << status << ": " << bytes;
    EXPECT_THAT(answer.body(), testing::Not(testing::HasSubstr(kSecret)));
  }
  EXPECT_EQ(server.counters().clients, 0);
  EXPECT_GE(server.counters().refused, 500u);
}

TEST_F(WebServerTest, LimitsConnections) {
  ConsoleOptions options = AnyPort();
  options.max_connections = 3;
  const WebServer server = ServeConsole(options, &feed_, kAssets);
  {
    std::vector<std::unique_ptr<TestBrowser>> silent;
    for (int i = 0; i < 3; ++i) silent.push_back(std::make_unique<TestBrowser>(server.port()));
    ASSERT_TRUE(Eventually([&] { return server.counters().connections == 3; }));
    TestBrowser one_more(server.port());
    EXPECT_EQ(one_more.Send(one_more.Get("/")).result_int(), 0u);
  }
  EXPECT_TRUE(Eventually([&] {
    TestBrowser browser(server.port());
    return browser.Send(browser.Get("/")).result_int() == 200;
  }));
}

TEST_F(WebServerTest, BadFramesEndConnection) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  for (const std::string& text : {std::string("{}"), std::string("garbage"),
                                  std::string(20000, ' '), std::string("{\"command\":\"rm\"}")}) {
    TestSocket socket(server.port());
    socket.Send(text);
    EXPECT_TRUE(socket.IsEnded()) << text.substr(0, 20);
  }
  TestSocket binary(server.port());
  binary.Send("{\"ack\":1}", /*is_text=*/false);
  EXPECT_TRUE(binary.IsEnded());
  TestSocket flood(server.port());
  for (int i = 0; i < 2000; ++i) flood.Send("{\"ack\":1}");
  EXPECT_TRUE(flood.IsEnded());
  EXPECT_TRUE(Eventually([&] { return server.counters().clients == 0; }));
}

TEST_F(WebServerTest, SendsCurrentStateToNewClients) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  feed_.Add(ViewStatus{"searching", "no pattern", false});
  feed_.Add(ViewStatus{"tracking", "", true});
  feed_.Add(SessionEvent{TimeFromNanoseconds(5), EventLevel::kWarning, "camera came back"});
  ASSERT_TRUE(Eventually([&] {
    TestSocket socket(server.port());
    const auto status = socket.Next("status");
    return (*status)["state"] == "tracking";
  }));
  TestSocket socket(server.port());
  EXPECT_EQ((*socket.Next("hello"))["series"][0]["unit"], "m");
  EXPECT_EQ((*socket.Next("event"))["text"], "camera came back");
  EXPECT_TRUE(feed_.IsWatched());
  feed_.Add(ViewSample{TimeFromNanoseconds(7), {std::numeric_limits<double>::quiet_NaN()}});
  const auto sample = socket.Next("sample");
  EXPECT_EQ((*sample)["time"], "7");
  EXPECT_TRUE((*sample)["values"][0].is_null());
}

TEST_F(WebServerTest, ForwardsCommandsToProgram) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  TestSocket socket(server.port());
  socket.Send(R"({"command": "record", "value": 1})");
  std::optional<ConsoleCommand> command;
  ASSERT_TRUE(Eventually([&] { return (command = feed_.TakeCommand()).has_value(); }));
  EXPECT_EQ(command->kind, ConsoleCommandKind::kRecord);
  EXPECT_EQ(command->value, 1);
}

TEST_F(WebServerTest, SendsNextImageAfterAcknowledgement) {
  ConsoleOptions options = AnyPort();
  options.max_image_rate_hz = 200;
  std::atomic<int> drawn{0};
  const auto draw = [&](const cv::Mat& image) {
    ++drawn;
    return image;
  };
  ConsoleFeed feed(
      {.title = "test", .series = {}, .layers = {}, .views = {{"x-ray", draw}}, .offers = {}});
  const WebServer server = ServeConsole(options, &feed, kAssets);
  TestSocket first(server.port()), second(server.port());
  for (TestSocket* socket : {&first, &second}) socket->Send(R"({"images": "x-ray"})");
  ASSERT_TRUE(Eventually([&] { return server.counters().clients == 2; }));
  const auto give = [&] {
    ConsoleFrame frame = SomeFrame();
    feed.SetFrame(&frame);
  };
  give();
  EXPECT_EQ((*first.Next("image"))["sequence"], 1);
  EXPECT_EQ((*second.Next("image"))["sequence"], 1);
  EXPECT_EQ(drawn, 1);
  // None of the browsers acknowledges the image: no more are drawn.
  for (int i = 0; i < 20; ++i) give();
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(first.Next("link"));  // half a second
  EXPECT_EQ(drawn, 1);
  first.Send(R"({"ack": 1})");
  EXPECT_EQ((*first.Next("image"))["sequence"], 21);
  second.Send(R"({"ack": 1})");
  EXPECT_EQ((*second.Next("image"))["sequence"], 21);
  EXPECT_EQ(drawn, 2);
  EXPECT_GT((*first.Next("link"))["draw_ms"], 0);
}

TEST_F(WebServerTest, UnknownViewEndsConnection) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  TestSocket socket(server.port());
  socket.Send(R"({"images": "x-ray"})");
  EXPECT_TRUE(socket.IsEnded());
}

TEST_F(WebServerTest, StalledBrowserDoesNotDelayOthers) {
  ConsoleOptions options = AnyPort();
  options.max_image_rate_hz = 200;
  options.message_queue = 8;
  options.idle_timeout_s = 4;
  const WebServer server = ServeConsole(options, &feed_, kAssets);
  TestSocket good(server.port());
  good.Send(R"({"images": true})");
  TestSocket stalled(server.port());  // reads nothing from now on
  stalled.Send(R"({"images": true})");
  ASSERT_TRUE(Eventually([&] { return server.counters().clients == 2; }));

  // Images and 4 MB of messages a second soon fill the buffers of the system.
  const cv::Mat noise = NoiseImage(1600, 1200);
  std::jthread vision([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      ConsoleFrame frame = SomeFrame();
      frame.image = noise;
      feed_.SetFrame(&frame);
      for (int i = 0; i < 10; ++i) feed_.Add(ViewStatus{std::string(2000, 's'), "", false});
      std::this_thread::sleep_for(5ms);  // the camera's pace
    }
  });
  std::uint64_t before = 0;
  for (int i = 0; i < 10; ++i) {
    const auto image = good.Next("image");
    ASSERT_TRUE(image);
    const std::uint64_t sequence = (*image)["sequence"];
    EXPECT_GT(sequence, before);
    before = sequence;
    good.Send(R"({"ack": )" + std::to_string(sequence) + "}");
  }
  // The stalled browser is disconnected, the good one is not.
  std::atomic<bool> is_one{false};
  std::thread reader([&] {
    while (!is_one && good.Read()) {
    }
  });
  is_one = Eventually([&] { return server.counters().clients == 1; });
  EXPECT_TRUE(is_one);
  vision.request_stop();
  reader.join();
  EXPECT_EQ(server.counters().clients, 1);
}

TEST_F(WebServerTest, DetectsDisconnectedBrowser) {
  const WebServer server = ServeConsole(AnyPort(), &feed_, kAssets);
  {
    TestSocket socket(server.port());
    ASSERT_TRUE(Eventually([&] { return server.counters().clients == 1; }));
  }
  EXPECT_TRUE(Eventually([&] { return !feed_.IsWatched(); }));
}

TEST_F(WebServerTest, StopsWithBrowsersConnected) {
  std::optional<WebServer> server(ServeConsole(AnyPort(), &feed_, kAssets));
  TestSocket socket(server->port());
  TestBrowser silent(server->port());
  ASSERT_TRUE(Eventually([&] { return server->counters().clients == 1; }));
  server.reset();
  EXPECT_TRUE(socket.IsEnded());
  EXPECT_FALSE(feed_.IsWatched());
}

}  // namespace
}  // namespace kestrel
