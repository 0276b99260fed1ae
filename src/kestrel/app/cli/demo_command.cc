// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/evaluation/evaluate_hunt.h"
#include "kestrel/app/evaluation/evaluate_landing.h"
#include "kestrel/app/evaluation/report.h"
#include "kestrel/app/evaluation/report_page.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// A UAV whose clock and mount are known.
constexpr char kCalibrated[] =
    " --set navigation.mount_error_deg=0 --set navigation.clock_offset_min_s=0"
    " --set navigation.clock_offset_max_s=0";

// Times at which the videos show the pad from near, or the most objects.
constexpr double kFollowStill_s = 2, kHuntStill_s = 2.75, kLandStill_s = 7.8;

// In a clone of Kestrel, where `make demo` runs.
constexpr char kGuide[] = "docs/first-landing.md";

// Runs a command of the program in this process, after showing it as one would type it.
void RunCommand(const std::string& words) {
  fmt::print(stderr, "\nkestrel {}\n", words);
  CLI::App app("", "kestrel");
  AddTaskCommands(&app);
  AddSimulateCommand(&app);
  app.parse(words);
  if (WasInterrupted()) throw Interrupted("interrupted");
}

// Returns the cell of a table's last row, which is that of all rows; "-" where there is none.
std::string CellOf(const Report& report, const std::string& table_name, const std::string& column) {
  for (const ReportTable& table : report.tables) {
    if (table.name != table_name || table.rows.empty()) continue;
    const auto place = std::find(table.columns.begin(), table.columns.end(), column);
    if (place == table.columns.end()) continue;
    return table.rows.back().at(static_cast<std::size_t>(place - table.columns.begin()));
  }
  return kUnknownCell;
}

// Returns the text of a length in m ("0.006") in cm ("0.6").
std::string InCentimetres(const std::string& metres) {
  return fmt::format("{:.1f} cm", 100 * std::strtod(metres.c_str(), nullptr));
}

// Captions of the plots of a chapter, by the names of their files.
const std::map<std::string, std::string>& PlotCaptions() {
  static const std::map<std::string, std::string> captions = {
      {"position", "Place of the pad in the world: true, detected, and the track that follows it."},
      {"plane", "Path of the pad from above: the track should lie on the true one."},
      {"error", "Errors over time: small ones near the pad, larger ones from high above."},
      {"rate", "Share of the images in which the pad was found, by altitude."},
      {"nees", "Whether the stated errors are honest: the average should lie within the bounds."},
      {"velocity", "Velocity of the pad: the estimate should lie on the true one."},
      {"prediction", "Error of the place where the pad is expected to be in a moment."},
      {"map",
       "The field from above. A circle with a cross is an object in the map. A gray circle was "
       "only passed: it was in view too briefly to be wanted there."},
      {"touchdown", "Paths of the UAV and of the car, from above and from the side."},
  };
  return captions;
}

// The demo: flights over a driving car and over coloured objects, and a landing on the car.
class Demo {
 public:
  Demo(const std::string& folder, bool force)
      : folder_(folder), files_(folder, force), forced_(force ? " --force" : "") {}

  void Run() {
    Follow();
    Hunt();
    Land();
    const std::string page = files_.NewFile("index.html").string();
    const std::vector<PageVideo>& landing = chapters_.back().videos;
    files_.OpenText("index.html") << ToHtml(
        "Kestrel: a landing on a moving car, by what it sees",
        landing.empty() ? std::nullopt : std::optional(landing.front()), verdict_, chapters_,
        NextSteps());
    fmt::print("\n");
    for (const PageVerdict& line : verdict_) fmt::print("{}\n", line.found);
    fmt::print("Videos, plots and figures: {}\n", page);
  }

 private:
  std::vector<PageStep> NextSteps() const {
    std::vector<PageStep> steps = {
        {"See the first flight frame by frame in the browser",
         "kestrel console " + Quoted("flight") + " " + Quoted("found"), ""},
        {"Let an autopilot land by what Kestrel sees",
         "kestrel fly sim:standing --autopilot sim:ardupilot --console", ""},
        {"Print a pad", "kestrel print --size 0.16 --output pad.pdf", ""},
        {"See your own camera, and calibrate its lens", "kestrel console /dev/video0", ""}};
    PageStep guide{"From a camera to a first landing: docs/first-landing.md", "", ""};
    if (const fs::path file = fs::absolute(kGuide); fs::exists(file)) {
      guide.file = file.lexically_relative(fs::absolute(folder_)).generic_string();
    }
    steps.push_back(guide);
    return steps;
  }

  std::string Quoted(const char* name) const { return "\"" + (folder_ / name).string() + "\""; }

  void Follow() {
    RunCommand("simulate landing --scenario figure8 --seed 7 --set frames=120 --set rate_hz=20" +
               (kCalibrated + forced_) + " --output " + Quoted("flight"));
    RunCommand("land " + Quoted("flight") + " --annotate --predict 0.5,1.0" + forced_ +
               " --output " + Quoted("found"));
    const Report report = Evaluated(EvaluateLanding, "flight", "found");
    verdict_.push_back({fmt::format("Landing pattern: found in {} of {} images, {} false",
                                    CellOf(report, "images", "found"),
                                    CellOf(report, "images", "with a quarter of it in view"),
                                    CellOf(report, "images", "false")),
                        "Good: more than 95 %. Needed: two images a second, and none false."});
    verdict_.push_back(
        {fmt::format("Its place in the world: {} off (root mean square, from 14 m down)",
                     InCentimetres(CellOf(report, "errors", "world RMS, m"))),
         "Good: below 10 cm. Needed: below 25 cm, or the UAV does not descend."});
    AddChapter("A car on a figure of eight, followed from above",
               "A UAV comes down over a car that drives in curves. The outline is what Kestrel "
               "found; the plots compare it with the truth of the simulation.",
               "found", report, kFollowStill_s);
  }

  void Hunt() {
    RunCommand("simulate hunt --scenario sweep --seed 3 --set frames=60 --set rate_hz=4" +
               (kCalibrated + forced_) + " --output " + Quoted("field"));
    RunCommand("hunt " + Quoted("field") + " --annotate --set hunt.readout_s=0.025" + forced_ +
               " --output " + Quoted("objects"));
    const Report report = Evaluated(EvaluateHunt, "field", "objects");
    verdict_.push_back(
        {fmt::format("Coloured objects: {} of {} in the map, {} false, {} from their true "
                     "places (mean)",
                     CellOf(report, "map", "in the map"), CellOf(report, "map", "objects"),
                     CellOf(report, "map", "false"),
                     InCentimetres(CellOf(report, "map", "position mean, m"))),
         "Good: all that were passed, none false. Needed: within 10 cm, to pick up "
         "a disc of 20 cm."});
    AddChapter("Coloured objects, found and mapped",
               "A UAV flies to and fro over a field with coloured discs, cuboids and bars.",
               "objects", report, kHuntStill_s);
  }

  void Land() {
    RunCommand("simulate touchdown --seed 1 --annotate" + forced_ + " --output " +
               Quoted("touchdown"));
    std::string summary = ReadFile((folder_ / "touchdown" / "summary.txt").string());
    summary.erase(summary.find_last_not_of('\n') + 1);
    verdict_.push_back(
        {"Landing on the car: " + summary,
         "Good: below 0.1 m from the centre. Needed: 0.5 m, the radius of the ring."});
    AddChapter("A landing on the car, by what Kestrel sees",
               "A simulated UAV in gusty wind has nothing but the track to land by.", "touchdown",
               Report(), kLandStill_s);
  }

  template <class Evaluate>
  Report Evaluated(const Evaluate& evaluate, const char* recording, const char* output) const {
    const fs::path result = folder_ / output;
    Report report = evaluate((folder_ / recording).string(), result.string());
    WriteReport(report, OutputFolder(result / "evaluation", !forced_.empty()));
    return report;
  }

  // Adds all videos and plots of an output folder. 'still_s': a time of the video at which what is
  // looked for is large in it.
  void AddChapter(const char* title, const char* text, const char* output, const Report& report,
                  double still_s) {
    PageChapter chapter{title, text, {}, {}, report.tables};
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / output)) {
      const std::string name = entry.path().lexically_relative(folder_).generic_string();
      const fs::path kind = entry.path().extension();
      if (entry.path().stem() == "annotated" && entry.is_regular_file()) {
        chapter.videos.push_back({name, still_s});
      } else if (kind == ".png" && name.find("/mav0/") == std::string::npos) {
        const auto caption = PlotCaptions().find(entry.path().stem().string());
        chapter.pictures.push_back(
            {name, caption == PlotCaptions().end() ? name : caption->second});
      }
    }
    std::ranges::sort(chapter.pictures, {}, &PagePicture::file);
    chapters_.push_back(chapter);
  }

  fs::path folder_;
  OutputFolder files_;
  std::string forced_;
  std::vector<PageVerdict> verdict_;
  std::vector<PageChapter> chapters_;
};

struct DemoArguments {
  std::string output = "kestrel_demo";
  bool force = false;
};

void RunDemo(const DemoArguments& arguments) {
  std::error_code ignored;
  const bool is_free =
      !fs::exists(arguments.output, ignored) || fs::is_empty(fs::path(arguments.output), ignored);
  if (!is_free && !arguments.force) {
    throw InputError(arguments.output + ": exists already; --force replaces the files in it");
  }
  fmt::print(stderr, "Three simulated flights, in about a minute; the verdict comes last.\n");
  Demo(arguments.output, arguments.force).Run();
}

}  // namespace

void AddDemoCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "demo", "Simulated flights, what Kestrel found in them, and how right it was");
  const auto arguments = std::make_shared<DemoArguments>();
  command
      ->add_option("--output", arguments->output,
                   "Folder for the videos, plots and the page index.html (default: kestrel_demo)")
      ->type_name("DIR");
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunDemo(*arguments); });
}

}  // namespace kestrel
