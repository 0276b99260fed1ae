// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/board_paint.h"

#include <variant>
#include <vector>

#include "kestrel/simulation/scene/landing_drawings.h"
#include "kestrel/simulation/scene/paint.h"

namespace kestrel {
namespace {

constexpr int kBoardPaint_px = 2048;
const Color kWhitePaint(0.78, 0.82, 0.84);

Drawing::Shape AreaOf(const PrintShape& shape) {
  if (const auto* const ring = std::get_if<PrintRing>(&shape.area)) {
    return Drawing::Ring{ring->center, ring->outer_radius_m, ring->inner_radius_m};
  }
  return Drawing::Polygon{std::get<PrintPolygon>(shape.area).loops};
}

// Shapes of one gray that are drawn one after the other.
struct Layer {
  Drawing area;
  double gray;
};

std::vector<Layer> LayersOf(const TargetPrint& print) {
  std::vector<Layer> layers;
  for (const PrintShape& shape : print.shapes) {
    if (layers.empty() || layers.back().gray != shape.gray) layers.push_back({{}, shape.gray});
    layers.back().area.Add(AreaOf(Moved(shape, print.board_heading, {0, 0})));
  }
  return layers;
}

}  // namespace

Drawing InkOf(const TargetPrint& print, double yaw) {
  Drawing ink;
  for (const PrintShape& shape : print.shapes) {
    const Drawing::Shape area = AreaOf(Moved(shape, yaw, {0, 0}));
    shape.gray == print.board_gray ? ink.Erase(area) : ink.Add(area);
  }
  return ink;
}

std::shared_ptr<const Texture> BoardPaint(const TargetPrint& print, const BoardWear& wear,
                                          int channels, Random* random) {
  std::vector<Layer> layers = LayersOf(print);
  const std::vector<Drawing::Shape> worn =
      WornPlaces({0, 0}, HalfExtent(print), wear.scratches, random);
  for (Layer& layer : layers) {
    if (layer.gray == print.board_gray) continue;  // without ink it looks the same
    for (const Drawing::Shape& place : worn) layer.area.Erase(place);
  }
  const Color black = Gray(random->Uniform(0.03, 0.06));
  const auto color_of = [&](double gray) -> Color {
    return (1 - gray) * black + gray * kWhitePaint;
  };
  SquarePaint paint(kBoardPaint_px, print.board_size_m + 2 * wear.border_m, Gray(0.035));
  paint.Draw(SquareBoard({0, 0}, print.board_size_m, 0), color_of(print.board_gray));
  for (const Layer& layer : layers) paint.Draw(layer.area, color_of(layer.gray));
  if (wear.dirt > 0) paint.Soil(wear.dirt, random->Bits());
  return paint.ToTexture(channels);
}

}  // namespace kestrel
