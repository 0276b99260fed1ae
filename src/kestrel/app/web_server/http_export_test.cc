// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "kestrel/app/console/console_page.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/read_file.h"

namespace kestrel {
namespace {

namespace http = boost::beast::http;

class HttpExportTest : public testing::Test {
 protected:
  // The request that the server has passed on.
  PendingExport TakePending() {
    std::optional<PendingExport> pending;
    EXPECT_TRUE(Eventually([&] { return (pending = feed_.TakeExport()).has_value(); }));
    return *pending;
  }
  // A file of several pieces.
  static ExportAnswer FileAnswer() {
    auto file = std::make_shared<ExportFile>();
    file->path = file->folder.path() + "/clip.mp4";
    std::ofstream out(file->path, std::ios::binary);
    std::mt19937 random(1);
    for (int i = 0; i < 300'000; ++i) out << static_cast<char>(random());
    out.close();
    return {.type = "video/mp4", .name = "clip-1-5.mp4", .file = file};
  }

  ConsoleFeed feed_{{.title = "test",
                     .series = {},
                     .layers = {},
                     .views = {},
                     .offers = {},
                     .has_exports = true}};
  WebServer server_ = ServeConsole(AnyPort(), &feed_);
  TestBrowser browser_{server_.port()};
};

TEST_F(HttpExportTest, SendsFileAndRemovesIt) {
  browser_.SendRequest(browser_.Get("/export/clip-1-5.mp4"));
  const PendingExport pending = TakePending();
  EXPECT_EQ(pending.request.last, 5u);
  EXPECT_TRUE(pending.is_wanted());
  ExportAnswer answer = FileAnswer();
  const std::string path = answer.file->path;
  const std::string content = ReadFile(path);
  pending.answer(answer);
  answer.file.reset();
  const auto response = browser_.ReadResponse();
  EXPECT_EQ(response.result_int(), 200u);
  EXPECT_EQ(response[http::field::content_type], "video/mp4");
  EXPECT_EQ(response[http::field::content_disposition], "attachment; filename=\"clip-1-5.mp4\"");
  EXPECT_EQ(response["Content-Security-Policy"].empty(), false);
  EXPECT_EQ(response[http::field::cache_control], "no-store");
  EXPECT_TRUE(response.body() == content);
  EXPECT_TRUE(Eventually([&] { return !std::filesystem::exists(path); }));
  // The same connection serves the next request.
  browser_.SendRequest(browser_.Get("/export/frame-1.png"));
  TakePending().answer({.content = "png", .type = "image/png", .name = "frame-1.png"});
  EXPECT_EQ(browser_.ReadResponse().body(), "png");
}

TEST_F(HttpExportTest, CancelsExportWhenClientDisconnects) {
  std::optional<TestBrowser> leaving(std::in_place, server_.port());
  leaving->SendRequest(leaving->Get("/export/clip-1-5.mp4"));
  const PendingExport pending = TakePending();
  EXPECT_TRUE(pending.is_wanted());
  leaving.reset();
  EXPECT_TRUE(Eventually([&] { return !pending.is_wanted(); }));
  pending.answer(FileAnswer());
  // The next browser is served.
  browser_.SendRequest(browser_.Get("/export/clip-1-5.mp4"));
  TakePending().answer({.refusal = "another clip is being made"});
  const auto refused = browser_.ReadResponse();
  EXPECT_EQ(refused.result_int(), 409u);
  EXPECT_EQ(refused.body(), "another clip is being made\n");
}

TEST_F(HttpExportTest, RefusesClipRequestFromOtherSite) {
  auto request = browser_.Get("/export/clip-1-5.mp4");
  request.set("Sec-Fetch-Site", "cross-site");
  request.set("Sec-Fetch-Mode", "navigate");
  EXPECT_EQ(browser_.Send(request).result_int(), 403u);
  EXPECT_FALSE(feed_.TakeExport());
}

}  // namespace
}  // namespace kestrel
