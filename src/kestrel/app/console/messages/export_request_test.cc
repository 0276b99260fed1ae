// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/export_request.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(ExportRequestTest, ReadsNumbersOfFramesAndRuns) {
  const auto frame = ParseExportPath("/export/frame-0.png");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->kind, ExportRequest::Kind::kFrame);
  EXPECT_EQ(frame->number, 0u);
  EXPECT_EQ(ParseExportPath("/export/overlays-123456789.png")->number, 123456789u);
  EXPECT_EQ(ParseExportPath("/export/detections-2.csv")->kind, ExportRequest::Kind::kDetections);
  const auto calibration = ParseExportPath("/export/calibration-3.yaml");
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->kind, ExportRequest::Kind::kCalibration);
  EXPECT_EQ(calibration->number, 3u);
}

TEST(ExportRequestTest, ReadsBothNumbersOfClip) {
  const auto clip = ParseExportPath("/export/clip-12-80.mp4");
  ASSERT_TRUE(clip);
  EXPECT_EQ(clip->kind, ExportRequest::Kind::kClip);
  EXPECT_EQ(clip->number, 12u);
  EXPECT_EQ(clip->last, 80u);
  const auto one = ParseExportPath("/export/overlays-7-7.mp4");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->kind, ExportRequest::Kind::kOverlaysClip);
  EXPECT_TRUE(IsClip(*one));
  EXPECT_FALSE(IsClip(*ParseExportPath("/export/overlays-7.png")));
}

TEST(ExportRequestTest, RefusesOtherPaths) {
  for (const char* path : {"",
                           "/",
                           "/export/",
                           "/export/frame-.png",
                           "/export/frame-1",
                           "/export/frame--1.png",
                           "/export/frame-1.png?",
                           "/export/frame-1.png/",
                           "/export/frame-1234567890.png",
                           "/export/frame-1%2e.png",
                           "/export/../frame-1.png",
                           "/export/frame-../../etc/passwd.png",
                           "/export/detections-0.csv",
                           "/export/detections-3.csv",
                           "/export/frame-1.csv",
                           "export/frame-1.png",
                           "/Export/frame-1.png",
                           "/export/frame- 1.png",
                           "/export/clip-2-1.mp4",
                           "/export/clip-1.mp4",
                           "/export/clip-1-.mp4",
                           "/export/clip--1.mp4",
                           "/export/clip-1-2-3.mp4",
                           "/export/clip-1-2.avi",
                           "/export/clip-1-1234567890.mp4",
                           "/export/clip-.mp4"}) {
    EXPECT_FALSE(ParseExportPath(path)) << path;
  }
}

}  // namespace
}  // namespace kestrel
