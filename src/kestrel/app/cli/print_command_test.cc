// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/rendering/test_worlds.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kCamera[] = R"(sensor_type: camera
rate_hz: 10
resolution: [1280, 960]
camera_model: pinhole
intrinsics: [950, 950, 640, 480]
distortion_model: none
distortion_coefficients: []
)";

class PrintCommandTest : public CommandTest {
 protected:
  // Renders the page of a PDF on a board on the ground, from the simulator's camera 1.8 m above it.
  static cv::Mat Photograph(const std::string& pdf, double size_m) {
    const std::string command = fmt::format("pdftoppm -r 50.8 -gray -singlefile '{0}' '{0}'", pdf);
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    cv::Mat paint = ReadImage(pdf + ".pgm");
    EXPECT_FALSE(paint.empty());
    paint.forEach<std::uint8_t>([](std::uint8_t& gray, const int*) {
      gray = CodeOfReflectance(0.05 + 0.75 * gray / 255);  // ink and paper
    });
    World world = PlainWorld(0.3);
    AddPlate(0, {0, 0, 0.01}, size_m / 2, size_m / 2, 0.3, std::make_shared<Texture>(paint, 1),
             &world);
    const CameraModel camera({1280, 960, 950, 950, 640, 480, DistortionModel::kNone, {}});
    const RigidTransform pose{
        LookingDown({0, 0, 0}).rotation * Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.8, 0.6, 0)),
        {0.2, -0.3, 1.8}};
    return FlightCamera(camera, {}, {}, {}, world, [&](double) { return pose; }).Capture(0, 1, 1);
  }

  std::string WriteCamera() const { return folder_.Write("camera.yaml", kCamera); }
};

TEST_F(PrintCommandTest, PrintsEveryPad) {
  folder_.Write("board.yaml", "tags:\n  - {family: tag36h11, id: 3, size_m: 0.1}\n");
  const std::string board = " --set landing.target.nested.board=" + folder_ / "board.yaml";
  for (const std::string kind : {"apriltag", "aruco", "nested", "ring-with-tags", "helipad"}) {
    const std::string pdf = folder_ / (kind + ".pdf");
    Succeed("print --target " + kind + board + " --output " + pdf);
    EXPECT_GT(std::filesystem::file_size(pdf), 1000) << kind;
  }
  ExpectInputError("print --target helipat --output " + folder_ / "x.pdf",
                   "did you mean 'helipad'?");
}

// A sheet of A4, dark around it as on a floor, from 1 m above.
TEST_F(PrintCommandTest, PrintsPadOfAnySizeOnOneSheetDetectably) {
  folder_.Write("board.yaml", "tags:\n  - {family: tag36h11, id: 3, size_m: 0.6}\n");
  const std::string board = " --set landing.target.nested.board=" + folder_ / "board.yaml";
  for (const std::string kind : {"ring-cross", "apriltag", "aruco", "nested", "helipad"}) {
    const std::string pdf = folder_ / (kind + ".pdf");
    const Outcome printed =
        Succeed("print --target " + kind + board + " --size 0.16 --output " + pdf);
    EXPECT_THAT(printed.err, HasSubstr("1 sheet\nPrint it on a4")) << kind;
    EXPECT_THAT(printed.err, HasSubstr("--target " + kind + " --target-size 0.16")) << kind;
    const std::string image = folder_ / kind;
    const std::string render =
        fmt::format("pdftoppm -r 40 -gray -singlefile '{}' '{}'", pdf, image);
    ASSERT_EQ(std::system(render.c_str()), 0) << render;
    const cv::Mat sheet = ReadImage(image + ".pgm");
    EXPECT_NEAR(sheet.cols, 0.210 / 0.0254 * 40, 1.5) << kind;
    cv::Mat floor(960, 1280, CV_8UC1, 90);
    sheet.copyTo(floor(cv::Rect(400, 200, sheet.cols, sheet.rows)));
    const std::string photo = WriteTestImage(folder_, kind + ".png", floor);
    const std::string land = "land " + photo + " --camera " + WriteCamera() + board;
    EXPECT_THAT(Run(land + " --target " + kind + " --target-size 0.16").err,
                HasSubstr("found in 1"))
        << kind;
  }
}

TEST_F(PrintCommandTest, PrintsLargePadOnOneSheet) {
  const std::string pdf = folder_ / "large.pdf";
  EXPECT_THAT(Succeed("print --size 1.2 --output " + pdf).err, Not(HasSubstr("sheet")));
  ExpectInputError("print --size 160 --output " + folder_ / "x.pdf", "metres: 0.16?");
  ExpectInputError("print --size -1 --output " + folder_ / "x.pdf", "size_m is -1");
}

TEST_F(PrintCommandTest, StarterHasNearAndFarPad) {
  const Outcome printed = Succeed("print --starter --output " + folder_ / "starter.pdf");
  EXPECT_THAT(printed.err, HasSubstr("1 sheet. Fly with it: kestrel fly ... --target-size 0.16"));
  EXPECT_THAT(printed.err, HasSubstr("--target-size 0.5"));
  EXPECT_EQ(Run("print --starter --size 0.3").status, 2);
}

TEST_F(PrintCommandTest, PrintedPatternIsDetectedAndMeasuredRight) {
  ASSERT_EQ(std::system("command -v pdftoppm >/dev/null"), 0)
      << "pdftoppm is not there: scripts/install-deps";
  const std::string pdf = folder_ / "pattern.pdf";
  Succeed("print --output " + pdf);
  const std::string photo = WriteTestImage(folder_, "photo.png", Photograph(pdf, 1.5));
  const std::string camera = " --camera " + WriteCamera();
  EXPECT_THAT(Run("land " + photo + camera).err, HasSubstr("pattern found in 1"));

  const std::string check = "print --check " + photo + camera;
  const Outcome right = Succeed(check);
  EXPECT_THAT(right.out, HasSubstr("no scale"));
  EXPECT_THAT(right.out, Not(HasSubstr("WRONG")));
  Succeed("print --check " + photo);
  const double distance = std::sqrt(0.2 * 0.2 + 0.3 * 0.3 + 1.79 * 1.79);
  const Outcome scaled = Succeed(check + fmt::format(" --distance {}", distance));
  EXPECT_THAT(scaled.out, HasSubstr("outer_diameter_m"));

  ExpectInputError(check + fmt::format(" --distance {}", 0.93 * distance), "outer_diameter_m=0.9");
  ExpectInputError(check + " --ruler 0.19", "outer_diameter_m=0.95");
  ExpectInputError(check + " --set landing.detector.pattern.ring_width_m=0.12",
                   "ring_width_m; print again at 100 %, or say what is there: --set "
                   "landing.detector.pattern.ring_width_m=0.1");
}

TEST_F(PrintCommandTest, WritesNamedFilesAndReplacesNothing) {
  const std::string first = folder_ / "first", second = folder_ / "second";
  const Outcome whole = Succeed("print --output " + first);
  EXPECT_THAT(whole.err, HasSubstr("first/landing_pattern.pdf\n"));
  const Outcome tiled = Succeed("print --paper a3 --output " + first);
  EXPECT_THAT(tiled.err, HasSubstr("16 sheets of 4 rows by 6; 8 blank ones are left out"));
  EXPECT_TRUE(std::filesystem::exists(first + "/landing_pattern_a3/sheet_4.5.svg"));
  EXPECT_FALSE(std::filesystem::exists(first + "/landing_pattern_a3/sheet_4.6.svg")) << "blank";
  ExpectInputError("print --output " + first, "landing_pattern.pdf: exists already");
  ExpectInputError("print --output " + (folder_ / "x.doc"), "x.doc: expected a name that ends in");
  Succeed("print --force --output " + first);

  Succeed("print --output " + second);
  Succeed("print --paper a3 --output " + second);
  for (const auto& file : std::filesystem::recursive_directory_iterator(first)) {
    if (!file.is_regular_file()) continue;
    const auto other = second / std::filesystem::relative(file.path(), first);
    EXPECT_TRUE(ReadFile(file.path()) == ReadFile(other)) << other << " has other bytes";
  }
}

TEST_F(PrintCommandTest, WritesOneFormatForOneFileName) {
  const std::string svg = folder_ / "mine.svg";
  Succeed("print --output " + svg);
  EXPECT_THAT(ReadFile(svg), HasSubstr("width=\"4251.96"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "mine.pdf"));
}

TEST_F(PrintCommandTest, ReportsFaults) {
  ExpectInputError(
      "print --output " + folder_ / "o" + " --set landing.detector.pattern.ring_width_m=0.7",
      "ring_width_m");
  ExpectInputError(
      "print --output " + folder_ / "o" + " --set landing.detector.pattern.board_size_m=7",
      "--paper");
  const std::string gray = WriteTestImage(folder_, "gray.png", cv::Mat(480, 640, CV_8UC1, 100));
  ExpectInputError("print --check " + gray, "no landing pattern that can be measured");
  ExpectInputError("print --check " + gray + " --camera " + WriteCamera(),
                   "the image is 640x480 px");
  ExpectInputError("print --check " + folder_ / "none.png", "none.png");
  for (const char* wrong :
       {"print --paper a5", "print --distance 2", "print --check x.png --distance 2",
        "print --check x.png --ruler -1", "print --check x.png --paper a4"}) {
    EXPECT_EQ(Run(wrong).status, 2) << wrong;
  }
}

}  // namespace
}  // namespace kestrel
