// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/pattern_print.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/calibration/print/canvas.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kMaxPage_m = 14400 * 0.0254 / 72;
constexpr Canvas::Ink kBlack{0, 0, 0};
constexpr Canvas::Ink kWhite{1, 1, 1};
constexpr Canvas::Ink kGray{0.5, 0.5, 0.5};  // for what is on the board but not part of the pad
constexpr Canvas::Ink kBlue{0.2, 0.5, 1};
constexpr double kTextHeight_m = 0.004;
constexpr double kThinLine_m = 0.0002;

// Adds the area of a shape to the path. P has y up, a canvas down.
void AddArea(const PrintRing& ring, Canvas* canvas) {
  cairo_t* const cairo = canvas->cairo();
  const Vector2d center(ring.center.x(), -ring.center.y());
  constexpr double kFrom = 0.5 * kPi, kTo = 2.5 * kPi;
  cairo_new_sub_path(cairo);
  cairo_arc(cairo, center.x(), center.y(), ring.outer_radius_m, kFrom, kTo);
  cairo_close_path(cairo);
  if (ring.inner_radius_m <= 0) return;
  cairo_new_sub_path(cairo);
  cairo_arc_negative(cairo, center.x(), center.y(), ring.inner_radius_m, kTo, kFrom);
  cairo_close_path(cairo);
}

void AddArea(const PrintPolygon& polygon, Canvas* canvas) {
  cairo_t* const cairo = canvas->cairo();
  for (const std::vector<Vector2d>& loop : polygon.loops) {
    cairo_move_to(cairo, loop[0].x(), -loop[0].y());
    for (std::size_t i = 1; i < loop.size(); ++i) {
      const Vector2d side = loop[i] - loop[i - 1];
      cairo_rel_line_to(cairo, side.x(), -side.y());
    }
    cairo_close_path(cairo);
  }
}

// The origin is the centre of the board.
void DrawShapes(const TargetPrint& print, Canvas* canvas) {
  for (const PrintShape& shape : print.shapes) {
    canvas->SetInk({shape.gray, shape.gray, shape.gray});
    std::visit([&](const auto& area) { AddArea(area, canvas); }, shape.area);
    canvas->Fill();
  }
}

// The origin is the upper left corner of the board.
void DrawBoard(const TargetPrint& print, Canvas* canvas) {
  const Vector2d size = Vector2d::Constant(print.board_size_m);
  if (print.board_gray < 1) {
    canvas->SetInk({print.board_gray, print.board_gray, print.board_gray});
    canvas->Rectangle({0, 0}, size);
    canvas->Fill();
  }
  canvas->Within(0.5 * size, -print.board_heading, 1, [&] { DrawShapes(print, canvas); });
}

// Draws to the right from the origin, with ticks upwards. 'scale': of ticks and text.
void DrawRuler(double length_m, double scale, Canvas* canvas) {
  constexpr int kTicks = 20;
  const double line = scale * kThinLine_m;
  canvas->Line({-0.5 * line, 0}, {length_m + 0.5 * line, 0}, line);
  for (int i = 0; i <= kTicks; ++i) {
    const double x = length_m * i / kTicks;
    const double tick = i % kTicks == 0 ? 0.0035 : i % 10 == 0 ? 0.003 : 0.002;
    canvas->Line({x, 0}, {x, -scale * tick}, line);
  }
  canvas->Text({length_m + scale * 0.002, 0}, 0.75 * scale * kTextHeight_m,
               fmt::format("{:.0f} mm", 1000 * length_m));
}

void DrawLines(const std::vector<std::string>& lines, const Vector2d& first, double height_m,
               double align, Canvas* canvas) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    canvas->Text(first + Vector2d(0, 1.4 * height_m * static_cast<double>(i)), height_m, lines[i],
                 align);
  }
}

// Draws rulers in the lower left corner of the board and text in the lower right one.
void DrawNotes(const TargetPrint& print, Canvas* canvas) {
  const double size = print.board_size_m;
  const double scale = std::min(1.0, size / 0.75);
  const double border = 0.006 * scale;
  canvas->SetInk(kGray);
  const double ruler = RulerLength(print.board_size_m);
  const Vector2d corner(border, size - border);
  canvas->Within(corner + Vector2d(border, 0), 0, 1, [&] { DrawRuler(ruler, scale, canvas); });
  canvas->Within(corner - Vector2d(0, border), -0.5 * kPi, 1,
                 [&] { DrawRuler(ruler, scale, canvas); });
  std::vector<std::string> lines = print.dimensions;
  lines.insert(lines.begin(), "Kestrel landing pattern");
  lines.push_back("Print at 100 %, matt, on a flat, stiff board; measure both rulers.");
  const double height = 0.75 * scale * kTextHeight_m;
  DrawLines(lines,
            {size - border, size - border - 1.4 * height * (static_cast<double>(lines.size()) - 1)},
            height, 1, canvas);
  const double line = scale * kThinLine_m;
  const auto corner_of = [&](int i) {
    return Vector2d(i == 1 || i == 2 ? size - 0.5 * line : 0.5 * line,
                    i >= 2 ? size - 0.5 * line : 0.5 * line);
  };
  for (int i = 0; i < 4; ++i) canvas->Line(corner_of(i), corner_of((i + 1) % 4), line);
}

void DrawWholeBoard(const TargetPrint& print, Canvas* canvas) {
  DrawBoard(print, canvas);
  DrawNotes(print, canvas);
}

// Draws marks at the four corners of the tile, outside of it.
void DrawCutMarks(const Tiling& tiling, Canvas* canvas) {
  constexpr double kFrom_m = 0.001, kTo_m = 0.005;
  for (const double right : {0.0, 1.0}) {
    for (const double down : {0.0, 1.0}) {
      const Vector2d corner =
          tiling.tile_on_sheet + Vector2d(right, down).cwiseProduct(tiling.tile);
      const Vector2d aside(2 * right - 1, 0), along(0, 2 * down - 1);
      for (const Vector2d& way : {aside, along}) {
        canvas->Line(corner + kFrom_m * way, corner + kTo_m * way, kThinLine_m);
      }
    }
  }
}

// Returns the lines of text below a tile: its place, or what is on the one sheet.
std::vector<std::string> LinesOf(const TiledPrint& pad, int row, int column) {
  const Tiling& tiling = pad.tiling;
  if (tiling.count() > 1) {
    return {fmt::format(
        "Sheet {}.{}: row {} of {}, column {} of {}. Print at 100 %, cut at the marks, glue edge "
        "to edge.",
        row + 1, column + 1, row + 1, tiling.rows, column + 1, tiling.columns)};
  }
  return {"Kestrel landing pad. " + pad.note,
          fmt::format("{}", fmt::join(pad.print.dimensions, "; ")),
          "Print at 100 % on matt paper, glue on a flat, stiff board that is white around it."};
}

void DrawTile(const TiledPrint& pad, int row, int column, Canvas* canvas) {
  const TargetPrint& print = pad.print;
  const Tiling& tiling = pad.tiling;
  canvas->Within(tiling.tile_on_sheet, 0, 1, [&] {
    canvas->Rectangle({0, 0}, tiling.tile);
    cairo_clip(canvas->cairo());
    canvas->Within(-tiling.TileOnBoard(row, column), 0, 1, [&] { DrawBoard(print, canvas); });
  });
  canvas->SetInk(kBlack);
  DrawCutMarks(tiling, canvas);
  const double left = std::max(tiling.tile_on_sheet.x(), 0.01);
  const double bottom = tiling.sheet.y();
  const std::vector<std::string> lines = LinesOf(pad, row, column);
  const double height = 0.75 * kTextHeight_m;
  DrawLines(
      lines,
      {left + 0.002, bottom - 0.0095 - 1.4 * height * (static_cast<double>(lines.size()) - 1)},
      height, 0, canvas);
  const double ruler = RulerLength(print.board_size_m);
  constexpr double kRoom_m = 0.02;  // for the ruler's label
  if (tiling.sheet.x() >= 2 * 0.01 + ruler + kRoom_m) {
    canvas->Within({left + 0.002, bottom - 0.005}, 0, 1, [&] { DrawRuler(ruler, 1, canvas); });
  } else {
    const Vector2d lower_left(0.009, tiling.tile_on_sheet.y() + tiling.tile.y() - 0.003);
    canvas->Within(lower_left, -0.5 * kPi, 1, [&] { DrawRuler(ruler, 1, canvas); });
  }
}

// Corners of a box with sides along the board's, in the board's frame.
struct BoardBox {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = -low;

  void Add(const Vector2d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  bool Meets(const BoardBox& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
};

bool Reaches(const PrintRing& ring, const Eigen::Isometry2d& board_from_pad, const BoardBox& tile) {
  const Vector2d center = board_from_pad * ring.center;
  const Vector2d nearest = center.cwiseMax(tile.low).cwiseMin(tile.high);
  const Vector2d farthest =
      (center - tile.low).cwiseAbs().cwiseMax((center - tile.high).cwiseAbs());
  return (nearest - center).norm() < ring.outer_radius_m && farthest.norm() > ring.inner_radius_m;
}

bool Reaches(const PrintPolygon& polygon, const Eigen::Isometry2d& board_from_pad,
             const BoardBox& tile) {
  BoardBox box;
  for (const std::vector<Vector2d>& loop : polygon.loops) {
    for (const Vector2d& corner : loop) box.Add(board_from_pad * corner);
  }
  return box.Meets(tile);
}

void DrawGrid(const TargetPrint& print, const Tiling& tiling, double line, Canvas* canvas) {
  const double size = print.board_size_m;
  canvas->SetInk(kBlue);
  for (int row = 0; row <= tiling.rows; ++row) {
    canvas->Line({0, row * tiling.tile.y()}, {size, row * tiling.tile.y()}, line);
  }
  for (int column = 0; column <= tiling.columns; ++column) {
    canvas->Line({column * tiling.tile.x(), 0}, {column * tiling.tile.x(), size}, line);
  }
  const double height = 0.2 * tiling.tile.minCoeff();
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      if (!HasPrint(print, tiling, row, column)) continue;
      const Vector2d middle = tiling.TileOnBoard(row, column) + 0.5 * tiling.tile;
      // On a plate, as the number is not to be read against the pad.
      canvas->SetInk(kWhite);
      canvas->Rectangle(middle - height * Vector2d(1.1, 0.6), height * Vector2d(2.2, 1.2));
      canvas->Fill();
      canvas->SetInk(kBlue);
      canvas->Text(middle + Vector2d(0, 0.35 * height), height,
                   fmt::format("{}.{}", row + 1, column + 1), 0.5);
    }
  }
}

void DrawOverview(const TiledPrint& pad, Canvas* canvas) {
  const TargetPrint& print = pad.print;
  const Tiling& tiling = pad.tiling;
  std::vector<std::string> lines = print.dimensions;
  lines.insert(lines.begin(), "Kestrel landing pattern: " + SheetsInWords(print, tiling));
  lines.insert(
      lines.end(),
      {"1. Print at 100 % (not \"fit to page\") on matt paper: gloss mirrors the sun.",
       fmt::format("2. Measure the ruler of a sheet: {:.1f} mm. If it is not, the printer scaled: "
                   "print again.",
                   1000 * RulerLength(print.board_size_m)),
       "3. Cut at the marks. Sheet 2.3 is the third of the second row, seen from the front.",
       "4. Glue edge to edge (nothing overlaps) on a flat, stiff, white board."});
  if (print.can_be_checked) {
    lines.emplace_back("5. Photograph it, all of it in view, and run: kestrel print --check PHOTO");
  }
  if (!pad.note.empty()) lines.push_back(pad.note);
  constexpr double kBorder_m = 0.015;
  const double height = kTextHeight_m * std::min(tiling.sheet.x() / 0.21, 3.0);
  const double text = 1.4 * height * static_cast<double>(lines.size());
  const double side =
      std::min(tiling.sheet.x() - 2 * kBorder_m, tiling.sheet.y() - 2 * kBorder_m - text - height);
  const double scale = side / print.board_size_m;
  canvas->Within({0.5 * (tiling.sheet.x() - side), kBorder_m}, 0, scale, [&] {
    DrawBoard(print, canvas);
    DrawGrid(print, tiling, 1.5 * kThinLine_m / scale, canvas);
  });
  canvas->SetInk(kBlack);
  DrawLines(lines, {kBorder_m, kBorder_m + side + 2 * height}, height, 0, canvas);
}

Canvas OnePage(Canvas::Format format, const TargetPrint& print, const std::string& file) {
  if (format == Canvas::Format::kPdf && print.board_size_m > kMaxPage_m) {
    throw InputError(
        fmt::format("a board of {:.4g} m is more than a page can have, {:.4g} m: tile it (--paper)",
                    print.board_size_m, kMaxPage_m));
  }
  return Canvas(format, file, Vector2d::Constant(print.board_size_m));
}

void PrintSvg(const Tiling& tiling, const std::string& file,
              const std::function<void(Canvas*)>& draw) {
  Canvas canvas(Canvas::Format::kSvg, file, tiling.sheet);
  draw(&canvas);
  canvas.Finish();
}

}  // namespace

bool HasPrint(const TargetPrint& print, const Tiling& tiling, int row, int column) {
  if (print.board_gray < 1) return true;
  // From the pad's frame, y up, to the board's, y down from its upper left corner.
  Eigen::Isometry2d board_from_pad = Eigen::Isometry2d::Identity();
  board_from_pad.linear() = Eigen::Vector2d(1, -1).asDiagonal() *
                            Eigen::Rotation2Dd(print.board_heading).toRotationMatrix();
  board_from_pad.translation().setConstant(0.5 * print.board_size_m);
  BoardBox tile;
  tile.Add(tiling.TileOnBoard(row, column));
  tile.Add(tiling.TileOnBoard(row + 1, column + 1));
  return std::any_of(print.shapes.begin(), print.shapes.end(), [&](const PrintShape& shape) {
    return std::visit([&](const auto& area) { return Reaches(area, board_from_pad, tile); },
                      shape.area);
  });
}

std::string SheetsInWords(const TargetPrint& print, const Tiling& tiling) {
  int sheets = 0;
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      sheets += HasPrint(print, tiling, row, column);
    }
  }
  if (sheets == 1) return "1 sheet";
  const int blank = tiling.count() - sheets;
  return fmt::format("{} sheets of {} rows by {}{}", sheets, tiling.rows, tiling.columns,
                     blank > 0 ? fmt::format("; {} blank ones are left out", blank) : "");
}

double RulerLength(double board_size_m) {
  constexpr double kLongest_m = 0.2;
  const double room = 0.25 * board_size_m;
  if (room >= kLongest_m) return kLongest_m;
  // Returns the largest of ... 0.01, 0.02, 0.05, 0.1 ... m that fits.
  const double decade = std::pow(10, std::floor(std::log10(room)));
  for (const double step : {5, 2}) {
    if (step * decade <= room) return step * decade;
  }
  return decade;
}

void PrintPatternPdf(const TargetPrint& print, const std::string& file) {
  Canvas canvas = OnePage(Canvas::Format::kPdf, print, file);
  DrawWholeBoard(print, &canvas);
  canvas.Finish();
}

void PrintPatternSvg(const TargetPrint& print, const std::string& file) {
  Canvas canvas = OnePage(Canvas::Format::kSvg, print, file);
  DrawWholeBoard(print, &canvas);
  canvas.Finish();
}

void PrintTilesPdf(const std::vector<TiledPrint>& pads, const std::string& file) {
  Canvas canvas(Canvas::Format::kPdf, file, pads.front().tiling.sheet);
  bool is_first = true;
  const auto add_page = [&](const auto& draw) {
    if (!is_first) canvas.NextPage();
    is_first = false;
    draw();
  };
  for (const TiledPrint& pad : pads) {
    const Tiling& tiling = pad.tiling;
    if (tiling.count() > 1) add_page([&] { DrawOverview(pad, &canvas); });
    for (int row = 0; row < tiling.rows; ++row) {
      for (int column = 0; column < tiling.columns; ++column) {
        if (!HasPrint(pad.print, tiling, row, column)) continue;
        add_page([&] { DrawTile(pad, row, column, &canvas); });
      }
    }
  }
  canvas.Finish();
}

void PrintOverviewSvg(const TiledPrint& pad, const std::string& file) {
  PrintSvg(pad.tiling, file, [&](Canvas* canvas) { DrawOverview(pad, canvas); });
}

void PrintTileSvg(const TiledPrint& pad, int row, int column, const std::string& file) {
  PrintSvg(pad.tiling, file, [&](Canvas* canvas) { DrawTile(pad, row, column, canvas); });
}

}  // namespace kestrel
