// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/colors/color_page.h"

#include <array>
#include <atomic>
#include <filesystem>
#include <memory>
#include <thread>
#include <zlib.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/console_page.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/codec/image_codec.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kPictures = 3;
const cv::Vec3b kPurple(200, 60, 190);
const cv::Vec3b kGround(90, 100, 95);

// Gray ground with a purple square that no built-in colour matches; darker from frame to frame.
cv::Mat Picture(std::size_t frame) {
  const double light = 1 - 0.2 * static_cast<double>(frame);
  cv::Mat image(80, 120, CV_8UC3, light * cv::Scalar(kGround));
  image(cv::Rect(40, 20, 30, 30)) = light * cv::Scalar(kPurple);
  return image;
}

class ColorPageTest : public testing::Test {
 protected:
  ColorSource Source() {
    return {"flight", kPictures,
            [this](std::size_t frame) {
              if (frame == missing_) throw InputError("frame2.png: no such file");
              return Picture(frame);
            },
            DefaultObjectModel(), folder_};
  }
  static ConsoleFeed::Description Description() {
    ConsoleFeed::Description description;
    description.is_live = false;
    description.has_exports = true;
    description.has_colors = true;
    return description;
  }
  static ConsoleOptions FreePort() {
    ConsoleOptions options;
    options.port = 0;
    return options;
  }
  // Sends a message and returns the state of the page after it.
  static nlohmann::json Request(TestSocket* socket, const std::string& message) {
    socket->Send(message);
    return socket->Next("colors").value_or(nlohmann::json());
  }
  // The labels of the frame's pixels, and their marks.
  std::array<cv::Mat1b, 2> Labels(std::size_t frame) {
    TestBrowser browser(server_.port());
    const auto response = browser.Send(browser.Get(fmt::format("/export/labels-{}.bin", frame)));
    EXPECT_EQ(response[boost::beast::http::field::content_encoding], "deflate");
    const cv::Size size = Picture(frame).size();
    cv::Mat1b both(2 * size.height, size.width);
    uLongf bytes = both.total();
    EXPECT_EQ(uncompress(both.data, &bytes, reinterpret_cast<const Bytef*>(response.body().data()),
                         response.body().size()),
              Z_OK);
    EXPECT_EQ(bytes, both.total());
    return {both.rowRange(0, size.height), both.rowRange(size.height, both.rows)};
  }

  const TestFolder test_folder_;
  const std::string folder_ = test_folder_ / "taught";
  std::atomic<std::size_t> missing_{99};
  ConsoleFeed feed_{Description()};
  WebServer server_ = ServeConsole(FreePort(), &feed_);
  std::unique_ptr<ColorPage> page_ = std::make_unique<ColorPage>(Source(), &feed_);
};

constexpr char kMarkPurple[] =
    R"({"colors": "mark", "frame": 0, "color": "green", "tool": "grow", "size": 8, "points": [50, 30]})";
constexpr char kMarkGround[] =
    R"({"colors": "mark", "frame": 0, "color": "", "tool": "rectangle", "size": 0, "points": [0, 0, 20, 20]})";

TEST_F(ColorPageTest, MarksTeachesShowsAndSavesColour) {
  TestSocket socket(server_.port());
  nlohmann::json state = socket.Next("colors").value_or(nlohmann::json());
  EXPECT_EQ(state["names"][3], "green");
  EXPECT_EQ(state["strokes"], 0);
  EXPECT_EQ(Request(&socket, R"({"colors": "choose", "color": "green"})")["color"], "green");
  state = Request(&socket, kMarkPurple);
  EXPECT_EQ(state["strokes"], 1);
  EXPECT_EQ(state["marked"], nlohmann::json::array({0}));
  EXPECT_EQ(Request(&socket, kMarkGround)["strokes"], 2);
  auto [labels, marks] = Labels(0);
  EXPECT_EQ(labels(30, 50), 0) << "not taught";
  EXPECT_EQ(marks(30, 50), 4) << "green is the fourth";
  EXPECT_EQ(marks(5, 5), 255) << "marked as none of the colours";
  state = Request(&socket, R"({"colors": "teach", "color": "green"})");
  EXPECT_FALSE(state["refused"]) << state["answer"];
  EXPECT_THAT(state["difference"].dump(), HasSubstr("name: green"));
  EXPECT_EQ(Labels(0)[0](30, 50), 4);
  EXPECT_EQ(Labels(0)[1](30, 50), 4);
  EXPECT_EQ(Labels(1)[0](30, 50), 4) << "in other light too";
  nlohmann::json scores;
  do {
    scores = socket.Next("color-scores").value_or(nlohmann::json{{"revision", -1}});
  } while (scores["revision"] != state["revision"] && scores["revision"] != -1);
  EXPECT_EQ(scores["wanted"], 900);
  EXPECT_EQ(scores["recall"], 1);
  EXPECT_EQ(scores["false_share"], 0);
  state = Request(&socket, R"({"colors": "save"})");
  EXPECT_TRUE(state["difference"].empty());
  const ObjectModel saved = ReadObjectModel(folder_ + "/objects.yaml");
  EXPECT_EQ(saved.colors.Classify(HsvFromBgr(kPurple[0], kPurple[1], kPurple[2])), 3U);
}

TEST_F(ColorPageTest, RestoresDraftWithoutUndoneStrokes) {
  {
    TestSocket socket(server_.port());
    ASSERT_TRUE(socket.Next("colors"));
    Request(&socket, kMarkPurple);
    Request(&socket, kMarkGround);
    EXPECT_TRUE(Request(&socket, R"({"colors": "undo"})")["can_redo"]);
  }
  TestSocket second(server_.port());
  EXPECT_EQ(second.Next("colors").value_or(nlohmann::json())["strokes"], 1) << "another browser";
  page_.reset();
  page_ = std::make_unique<ColorPage>(Source(), &feed_);
  EXPECT_EQ(Request(&second, R"({"colors": "redo"})")["strokes"], 1)
      << "another run of the program";
  // Another recording in the same folder has another draft.
  page_.reset();
  ColorSource other = Source();
  other.recording = "another flight";
  EXPECT_EQ(ColorSession(other).state().strokes, 0U);
  WriteFile(folder_ + "/draft.yaml", "recording: [");
  EXPECT_THROW(ColorSession{Source()}, InputError);
}

TEST_F(ColorPageTest, RefusedRequestIsReportedAndChangesNothing) {
  TestSocket socket(server_.port());
  ASSERT_TRUE(socket.Next("colors"));
  nlohmann::json state = Request(&socket, R"({"colors": "teach", "color": "green"})");
  EXPECT_TRUE(state["refused"]);
  EXPECT_THAT(state["answer"].get<std::string>(), HasSubstr("expected at least 10"));
  state = Request(&socket, R"({"colors": "choose", "color": "pink"})");
  EXPECT_THAT(state["answer"].get<std::string>(), HasSubstr("'pink' is none"));
  state =
      Request(&socket, R"({"colors": "mark", "frame": 3, "color": "", "tool": "grow", "size": 8,)"
                       R"( "points": [1, 1]})");
  EXPECT_THAT(state["answer"].get<std::string>(), HasSubstr("frame 3 is marked, expected 0 to 2"));
  missing_ = 2;
  state =
      Request(&socket, R"({"colors": "mark", "frame": 2, "color": "", "tool": "grow", "size": 8,)"
                       R"( "points": [1, 1]})");
  EXPECT_EQ(state["answer"], "frame2.png: no such file");
  EXPECT_EQ(state["strokes"], 0);
  TestBrowser browser(server_.port());
  EXPECT_EQ(browser.Send(browser.Get("/export/picture-2.jpg")).result_int(), 404u);
  EXPECT_FALSE(std::filesystem::exists(folder_)) << "nothing is to be kept";
}

TEST_F(ColorPageTest, KeepsVersionsWhenRevertedAndSavedAgain) {
  TestSocket socket(server_.port());
  ASSERT_TRUE(socket.Next("colors"));
  Request(&socket, R"({"colors": "save"})");
  Request(&socket, kMarkPurple);
  Request(&socket, R"({"colors": "teach", "color": "green"})");
  nlohmann::json state = Request(&socket, R"({"colors": "revert"})");
  EXPECT_TRUE(state["difference"].empty());
  EXPECT_EQ(Labels(0)[0](30, 50), 0);
  Request(&socket, R"({"colors": "teach", "color": "green"})");
  state = Request(&socket, R"({"colors": "save"})");
  EXPECT_EQ(state["versions"].size(), 1U);
  EXPECT_EQ(ReadFile(folder_ + "/objects.yaml.1"), PrintObjectModel(DefaultObjectModel()));
}

TEST_F(ColorPageTest, SendsPicturesOfFrameInColour) {
  TestBrowser browser(server_.port());
  const std::string jpeg = browser.Send(browser.Get("/export/picture-1.jpg")).body();
  const cv::Mat picture = DecodeImage(jpeg, "picture");
  ASSERT_EQ(picture.size(), cv::Size(120, 80));
  EXPECT_LT(cv::norm(picture.at<cv::Vec3b>(35, 55), Picture(1).at<cv::Vec3b>(35, 55)), 20);
  TestBrowser another(server_.port());
  EXPECT_EQ(another.Send(another.Get("/export/labels-3.bin")).result_int(), 404u);
}

TEST_F(ColorPageTest, KeepsNoFrameOfRecording) {
  TestSocket socket(server_.port());
  EXPECT_EQ((*socket.Next("colors"))["most_kept"], 0);
  const nlohmann::json state = Request(&socket, R"({"colors": "keep"})");
  EXPECT_TRUE(state["refused"]);
  EXPECT_EQ(state["frames"], kPictures);
}

TEST_F(ColorPageTest, KeepsAndMarksFramesOfCamera) {
  page_.reset();
  ColorSource camera = Source();
  camera.frame_count = 0;
  std::size_t kept = 0;  // used by the page's thread
  camera.keep = [&kept] {
    if (kept == 2) throw InputError("there is no room for more");
    return fmt::format("frame {} is kept", ++kept);
  };
  camera.warn = [] { return std::vector<std::string>{"the white balance is automatic"}; };
  TestSocket socket(server_.port());
  ASSERT_TRUE(socket.Next("colors"));  // state of the page before
  page_ = std::make_unique<ColorPage>(camera, &feed_);
  nlohmann::json state = socket.Next("colors").value_or(nlohmann::json());
  EXPECT_EQ(state["frames"], 0);
  EXPECT_EQ(state["most_kept"], 32);
  EXPECT_THAT(state["warnings"].dump(), HasSubstr("the white balance is automatic"));
  EXPECT_EQ(Request(&socket, kMarkPurple)["answer"], "there is no frame to be marked");
  state = Request(&socket, R"({"colors": "keep"})");
  EXPECT_EQ(state["frames"], 1);
  EXPECT_EQ(state["answer"], "frame 1 is kept");
  EXPECT_EQ(Request(&socket, R"({"colors": "keep"})")["frames"], 2);
  state = Request(&socket, R"({"colors": "keep"})");
  EXPECT_TRUE(state["refused"]);
  EXPECT_EQ(state["frames"], 2);
  EXPECT_EQ(Request(&socket, kMarkPurple)["strokes"], 1);
  EXPECT_FALSE(Request(&socket, R"({"colors": "teach", "color": "green"})")["refused"]);
  EXPECT_EQ(Labels(1)[0](30, 50), 4) << "seen in a frame that was not marked";
  page_.reset();  // before the variables that its functions use
}

}  // namespace
}  // namespace kestrel
