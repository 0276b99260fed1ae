// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/clip_maker.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/video_source.h"

namespace kestrel {
namespace {

// A request with its answer.
struct Requested {
  std::optional<ExportAnswer> answer;
  bool is_wanted = true;
};

class ClipMakerTest : public testing::Test {
 protected:
  void TearDown() override { is_held_ = false; }

  static Clip Grays(std::size_t frames) {
    const auto open = [] {
      return [](std::size_t i) { return cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(20.0 * i)); };
    };
    return {open, frames, 10, "clip-0"};
  }
  // A clip whose first frame waits while 'is_held'.
  Clip Held() {
    const auto open = [this] {
      return [this](std::size_t) {
        is_begun_ = true;
        while (is_held_) std::this_thread::yield();
        return cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(0));
      };
    };
    return {open, 1000, 10, "held"};
  }
  PendingExport Request(Requested* requested) {
    return {{ExportRequest::Kind::kClip, 0, 1},
            [requested](const ExportAnswer& answer) { requested->answer = answer; },
            [requested] { return requested->is_wanted; }};
  }
  bool Follow(const Requested& requested) {
    return Eventually([&] {
      maker_.Follow();
      return requested.answer.has_value();
    });
  }
  // The last progress that the page got; nothing when it got none.
  std::optional<ConsoleClip> Reported() {
    std::optional<ConsoleClip> reported;
    while (const auto update = feed_.TakeUpdate()) {
      if (const auto* clip = std::get_if<ConsoleClip>(&*update)) reported = *clip;
    }
    return reported;
  }

  std::atomic<bool> is_held_{true}, is_begun_{false};
  ConsoleFeed feed_{{}};
  ClipMaker maker_{&feed_};
};

TEST_F(ClipMakerTest, ClipHasFramesAndIsRemovedWithItsLastOwner) {
  Requested requested;
  maker_.Make(Request(&requested), Grays(9));
  ASSERT_TRUE(Reported());
  ASSERT_TRUE(Follow(requested));
  ASSERT_TRUE(requested.answer->file) << requested.answer->refusal;
  EXPECT_EQ(Reported()->frames, 0u);
  const std::string path = requested.answer->file->path;
  EXPECT_EQ(requested.answer->name, "clip-0" + std::filesystem::path(path).extension().string());
  const auto video = OpenVideoFile(path);
  int frames = 0;
  for (Frame frame; video->Next(&frame); ++frames) {
    EXPECT_NEAR(cv::mean(frame.image)[0], 20.0 * frames, 8) << frames;
  }
  EXPECT_EQ(frames, 9);
  requested.answer.reset();
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(path).parent_path()));
}

TEST_F(ClipMakerTest, RefusesSecondClipAtATime) {
  Requested first, second;
  maker_.Make(Request(&first), Held());
  maker_.Make(Request(&second), Grays(1));
  ASSERT_TRUE(second.answer);
  EXPECT_NE(second.answer->refusal.find("another clip"), std::string::npos);
  is_held_ = false;
  ASSERT_TRUE(Follow(first));
  EXPECT_TRUE(first.answer->file);
}

TEST_F(ClipMakerTest, CancelsClipNobodyWaitsFor) {
  Requested gone, next;
  maker_.Make(Request(&gone), Held());
  ASSERT_TRUE(Eventually([&] { return is_begun_.load(); }));
  gone.is_wanted = false;
  maker_.Follow();
  is_held_ = false;
  // After its end, which is not reported, another clip can be made.
  ASSERT_TRUE(Eventually([&] {
    maker_.Follow();
    next.answer.reset();
    maker_.Make(Request(&next), Grays(1));
    return !next.answer;
  }));
  ASSERT_TRUE(Follow(next));
  EXPECT_TRUE(next.answer->file);
  EXPECT_FALSE(gone.answer);
}

TEST_F(ClipMakerTest, ReportsWhyClipFails) {
  Requested requested;
  const auto open = []() -> Clip::Picture {
    return [](std::size_t) -> cv::Mat { throw InputError("frame7.png: no such file"); };
  };
  maker_.Make(Request(&requested), {open, 5, 10, "clip"});
  ASSERT_TRUE(Follow(requested));
  EXPECT_EQ(requested.answer->refusal, "frame7.png: no such file");
  EXPECT_FALSE(requested.answer->file);
}

}  // namespace
}  // namespace kestrel
