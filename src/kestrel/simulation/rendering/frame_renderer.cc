// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/frame_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kMomentsPerExposure = 64;
constexpr int kMaxMoments = 2048;
constexpr float kFarthest_m = 3000;

// Rays sample the paint at a level this much finer than the pixel: the average over the rays does
// the rest.
constexpr float kRayFootprint = 0.5f;

// Step of a sequence that fills the unit cube evenly (Roberts' R3): place in the pixel, moment.
const Vector3f kStep(0.8191725134f, 0.6710436067f, 0.5497004779f);

// Returns a point of the unit cube [0, 1) from 63 of the bits.
Vector3f UnitCube(std::uint64_t bits) {
  const auto part = [bits](int shift) {
    return static_cast<float>((bits >> shift) & 0x1FFFFF) * 0x1p-21f;
  };
  return {part(0), part(21), part(42)};
}

float Fraction(float x) { return x - std::floor(x); }

// Returns places on the sun's disc, for soft shadows.
std::array<Vector2f, 64> MakeDisc() {
  std::array<Vector2f, 64> places;
  for (int i = 0; i < 64; ++i) {
    const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / 64);
    const float angle = 2.39996f * static_cast<float>(i);  // the golden angle
    places[i] = radius * Vector2f(std::cos(angle), std::sin(angle));
  }
  return places;
}
const std::array<Vector2f, 64> kSunDisc = MakeDisc();

template <int kChannels>
Light<kChannels> InChannels(const Eigen::Vector3d& bgr) {
  if constexpr (kChannels == 1) {
    return Light<1>::Constant(1);
  } else {
    return bgr.cast<float>().array();
  }
}

// The end of a ray.
struct Hit {
  int seen = -1;  // -1: the sky
  float w = 0;    // 1 / distance
  float x = 0;    // on the surface
  float y = 0;
};

// Computes the pixels of one frame.
template <int kChannels>
class Painter {
 public:
  using Color = Light<kChannels>;

  Painter(const World& world, const FrameView& view, float moment_step_s, int middle)
      : world_(world),
        view_(view),
        moment_step_s_(moment_step_s),
        middle_(middle),
        sun_color_(InChannels<kChannels>(world.light.sun_color)),
        sky_color_(InChannels<kChannels>(world.light.sky_color)),
        map_middle_(0.5f * static_cast<float>(world.ground.map->width_px())),
        map_per_m_(static_cast<float>(world.ground.map->width_px() / world.ground.map_size_m)),
        detail_per_m_(
            static_cast<float>(world.ground.detail->width_px() / world.ground.detail_size_m)) {}

  void StartTile(std::size_t tile) {
    surfaces_ = view_.SurfacesIn(tile);
    ground_shadows_ = view_.GroundShadowsIn(tile);
  }
  // 'pixel_angle': side of the pixel, rad.
  void StartPixel(float pixel_angle) {
    pixel_angle_ = pixel_angle;
    level_of_ = -1;
    shade_of_ = -1;
  }

  Color LightOf(const Vector3f& ray, int moment, const Vector2f& sun_jitter) {
    const Hit hit = FirstHit(ray, moment);
    if (hit.seen < 0) return Sky(view_.WorldFromCamera(moment) * ray);
    const SeenSurface& seen = view_.seen(hit.seen);
    const Color paint = hit.seen == 0 ? GroundPaint(hit) : SurfacePaint(hit);
    const float sun = seen.direct > 0 ? seen.direct * Sunlit(hit, moment, sun_jitter) : 0.0f;
    Color light = paint * (seen.ambient * sky_color_ + sun * sun_color_);
    if (hit.seen > 0 && seen.surface->gloss > 0 && sun > 0) {
      light += Glare(seen, view_.WorldFromCamera(moment) * ray) * (sun / seen.direct) * sun_color_;
    }
    return Hazy(light, hit.w, ray);
  }

  // Returns the sunlight that the lens scatters into a pixel that looks along 'ray'.
  Color Flare(const Vector3f& ray) const {
    if (world_.light.flare <= 0) return Color::Zero();
    constexpr float kWidth2 = 0.12f * 0.12f;  // squared angle at which it has faded to a half
    const Vector3f to_sun = world_.light.to_sun.cast<float>();
    const float angle2 = 2 * (1 - to_sun.dot(view_.WorldFromCamera(middle_) * ray.normalized()));
    return static_cast<float>(world_.light.flare) / (1 + angle2 / kWidth2) * sun_color_;
  }

 private:
  Hit FirstHit(const Vector3f& ray, int moment) const {
    Hit hit;
    const Vector3f ground = view_.Homography(moment, 0) * ray;
    if (ground.z() > 1 / kFarthest_m) hit = {0, ground.z(), ground.x(), ground.y()};
    for (const int i : surfaces_) {
      const Vector3f on = view_.Homography(moment, i) * ray;
      if (on.z() <= hit.w || std::abs(on.x()) > on.z() || std::abs(on.y()) > on.z()) continue;
      const Surface& surface = *view_.seen(i).surface;
      if (surface.round && on.x() * on.x() + on.y() * on.y() > on.z() * on.z()) continue;
      if (surface.mask && IsHole(*surface.mask, on)) continue;
      hit = {i, on.z(), on.x(), on.y()};
    }
    if (hit.seen >= 0) {
      hit.x /= hit.w;
      hit.y /= hit.w;
    }
    return hit;
  }

  static bool IsHole(const Texture& mask, const Vector3f& on) {
    return mask.Sample<1>(0.5f * (1 + on.x() / on.z()) * mask.width_px(),
                          0.5f * (1 - on.y() / on.z()) * mask.height_px(), 0)[0] < 0.5f;
  }

  // Chooses the paint's level for the pixel's part of the surface.
  void FindLevel(const Hit& hit) {
    if (level_of_ == hit.seen) return;
    level_of_ = hit.seen;
    const SeenSurface& seen = view_.seen(hit.seen);
    const float sine = std::max(static_cast<float>(seen.plane_distance) * hit.w, 1e-3f);
    const float footprint_m = kRayFootprint * pixel_angle_ / (hit.w * std::sqrt(sine));
    const Texture& paint = hit.seen == 0 ? *world_.ground.map : *seen.surface->paint;
    level_ = paint.LevelOf(footprint_m / static_cast<float>(seen.pixel_size_m));
    if (hit.seen > 0) return;
    detail_level_ = world_.ground.detail->LevelOf(footprint_m * detail_per_m_);
  }

  Color GroundPaint(const Hit& hit) {
    FindLevel(hit);
    const Ground& ground = world_.ground;
    Color paint = ground.map->Sample<kChannels>(map_middle_ + map_per_m_ * hit.x,
                                                map_middle_ - map_per_m_ * hit.y, level_);
    constexpr int kEvenLevel = 5;  // from here on the detail is even
    if (detail_level_ < kEvenLevel) {
      const auto scale = static_cast<float>(ground.detail->width_px() / ground.detail_size_m);
      paint *=
          ground.detail->Sample<1>(scale * hit.x, -scale * hit.y, detail_level_)[0] / kDetailMean;
    }
    return paint;
  }

  Color SurfacePaint(const Hit& hit) {
    FindLevel(hit);
    const Texture& paint = *view_.seen(hit.seen).surface->paint;
    return paint.Sample<kChannels>(0.5f * (1 + hit.x) * static_cast<float>(paint.width_px()),
                                   0.5f * (1 - hit.y) * static_cast<float>(paint.height_px()),
                                   level_);
  }

  // Returns the part of the sun that reaches a point past the things in the world.
  float Sunlit(const Hit& hit, int moment, const Vector2f& jitter) {
    const SeenSurface& seen = view_.seen(hit.seen);
    float light = FarShade(hit);
    const float time_s = static_cast<float>(moment - middle_) * moment_step_s_;
    if (hit.seen == 0) {
      for (const int k : ground_shadows_) {
        light *= 1 - seen.shadows[k].Opacity(hit.x, hit.y, jitter, time_s);
      }
    } else {
      for (const ShadowMap& shadow : seen.shadows) {
        light *= 1 - shadow.Opacity(hit.x, hit.y, jitter, time_s);
      }
    }
    return light;
  }

  // The same past things far away. Its edges are soft: one sample per pixel is enough.
  float FarShade(const Hit& hit) {
    if (!world_.ground.sunlit || shade_of_ == hit.seen) return shade_;
    shade_of_ = hit.seen;
    const Texture& sunlit = *world_.ground.sunlit;
    const Vector2f at = view_.seen(hit.seen).ground_from_point * Vector3f(hit.x, hit.y, 1);
    const auto per_m = static_cast<float>(sunlit.width_px() / world_.ground.map_size_m);
    const float half = 0.5f * static_cast<float>(sunlit.width_px());
    shade_ = sunlit.Sample<1>(half + per_m * at.x(), half - per_m * at.y(), 0)[0];
    return shade_;
  }

  // Returns the blurred mirror image of the sun.
  float Glare(const SeenSurface& seen, const Vector3f& ray_in_world) const {
    const Vector3f mirrored = ray_in_world - 2 * seen.normal.dot(ray_in_world) * seen.normal;
    const float cosine = mirrored.dot(world_.light.to_sun.cast<float>());
    const float width = seen.surface->gloss_width;
    return seen.surface->gloss * std::exp(2 * (cosine - 1) / (width * width));
  }

  Color Sky(const Vector3f& ray_in_world) const {
    const auto steps = static_cast<float>(world_.skyline.size());
    const float turn =
        std::atan2(ray_in_world.y(), ray_in_world.x()) / (2 * std::numbers::pi_v<float>);
    const auto step = static_cast<std::size_t>(Fraction(turn) * steps) % world_.skyline.size();
    if (ray_in_world.z() < world_.skyline[step]) {
      return Hazy(world_.skyline_radiance * sky_color_, 1 / 80.0f, ray_in_world);
    }
    const auto radiance = static_cast<float>(world_.light.sky_radiance);
    return radiance * (1 - 0.3f * ray_in_world.z()) * sky_color_;
  }

  Color Hazy(const Color& light, float w, const Vector3f& ray) const {
    const Lighting& air = world_.light;
    if (air.haze_per_m <= 0) return light;
    const float clouds = std::sin(5 * ray.x() + 2 * std::sin(4 * ray.y() + 1)) *
                         std::sin(4 * ray.y() + 2 * std::sin(6 * ray.x()));
    const float density = 1 + static_cast<float>(air.haze_variation) * clouds;
    const float left = std::exp(-static_cast<float>(air.haze_per_m) * density / w);
    return light * left + (1 - left) * static_cast<float>(air.haze_radiance) * sky_color_;
  }

  const World& world_;
  const FrameView& view_;
  float moment_step_s_;
  int middle_;
  Color sun_color_;
  Color sky_color_;
  float map_middle_;  // px
  float map_per_m_;   // px
  float detail_per_m_;
  std::span<const int> surfaces_;
  std::span<const int> ground_shadows_;
  float pixel_angle_ = 0;
  int level_of_ = -1;  // surface to which the values below belong
  int level_ = 0;
  int detail_level_ = 0;
  int shade_of_ = -1;  // surface for which FarShade is known
  float shade_ = 1;
};

// Returns the side of a pixel as an angle (rad), from the rays of its corners.
float PixelAngle(const std::array<Vector3f, 4>& corners) {
  return std::sqrt((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm());
}

}  // namespace

FrameRenderer::FrameRenderer(const Lens& lens, const World& world, const ShutterOptions& shutter)
    : lens_(lens), world_(world), shutter_(shutter), tiles_(lens) {
  RequireValid(shutter);
}

double FrameRenderer::RowTime(double v) const {
  const double last = std::max(lens_.camera().height_px() - 1, 1);
  return shutter_.readout_s * (v / last - 0.5);
}

cv::Mat FrameRenderer::Render(double time_s, const Motion& world_from_camera,
                              std::uint64_t seed) const {
  if (world_.channels == 1) return RenderChannels<1>(time_s, world_from_camera, seed);
  return RenderChannels<3>(time_s, world_from_camera, seed);
}

template <int kChannels>
cv::Mat FrameRenderer::RenderChannels(double time_s, const Motion& world_from_camera,
                                      std::uint64_t seed) const {
  const double span_s = shutter_.readout_s + shutter_.exposure_s;
  const double wanted = std::ceil(kMomentsPerExposure * span_s / shutter_.exposure_s);
  const int moments = static_cast<int>(std::min<double>(wanted, kMaxMoments));
  const double step_s = span_s / moments;
  std::vector<double> times_s(moments);
  for (int k = 0; k < moments; ++k) times_s[k] = time_s - 0.5 * span_s + (k + 0.5) * step_s;
  const FrameView view(world_, tiles_, world_from_camera, times_s, time_s);
  Painter<kChannels> painter(world_, view, static_cast<float>(step_s), moments / 2);

  cv::Mat image(lens_.gain().size(), CV_32FC(kChannels), cv::Scalar::all(0));
  const auto per_exposure = static_cast<float>(shutter_.exposure_s / step_s);
  for (std::size_t i = 0; i < tiles_.tiles().size(); ++i) {
    const ImageTiles::Tile& tile = tiles_.tiles()[i];
    if (tile.dark) continue;
    painter.StartTile(i);
    for (int v = tile.top; v < std::min(tile.top + ImageTiles::kSide_px, image.rows); ++v) {
      const auto first = static_cast<float>((RowTime(v) + 0.5 * shutter_.readout_s) / step_s);
      for (int u = tile.left; u < std::min(tile.left + ImageTiles::kSide_px, image.cols); ++u) {
        if (lens_.gain().at<float>(v, u) <= 0) continue;
        const std::array<Vector3f, 4> corners = lens_.PixelCorners(u, v);
        painter.StartPixel(PixelAngle(corners));
        const std::uint64_t bits = Hash(seed, static_cast<std::uint64_t>(v) * image.cols + u);
        Vector3f place = UnitCube(bits);
        Light<kChannels> sum = Light<kChannels>::Zero();
        for (int k = 0; k < shutter_.rays_per_pixel; ++k) {
          const Vector3f right = corners[1] - corners[0];
          const Vector3f ray =
              corners[0] + place.x() * right +
              place.y() * (corners[2] - corners[0] + place.x() * (corners[3] - corners[2] - right));
          const int moment =
              std::min(static_cast<int>(first + place.z() * per_exposure), moments - 1);
          sum += painter.LightOf(ray, moment, kSunDisc[(bits + 8 * k + k / 8) % 64]);
          place += kStep;
          place -= (place.array() >= 1).cast<float>().matrix();
        }
        Eigen::Map<Light<kChannels>>(image.ptr<float>(v) + kChannels * u) =
            sum / static_cast<float>(shutter_.rays_per_pixel) + painter.Flare(corners[0]);
      }
    }
  }
  return image;
}

}  // namespace kestrel
