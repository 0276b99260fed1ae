// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/board_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/vision/tags/tag_match.h"

namespace kestrel {
namespace {

constexpr std::size_t kLeastCorners = 8;
constexpr double kLeastSpread = 0.03;  // spread of the corners in the image, share of its width

struct BoardCorner {
  Eigen::Vector2d on_board;
  cv::Point2f pixel;
};

// A tag in the image: its corners from the upper left one, clockwise.
struct SeenTag {
  const TagModel* tag;
  std::array<cv::Point2f, 4> pixels;
  double side_px;

  Eigen::Vector2d OnBoard(int corner) const {
    const double half = 0.5 * tag->size_m;
    const double x = corner == 0 || corner == 3 ? -half : half;
    const double y = corner < 2 ? half : -half;
    return (tag->board_from_tag * Eigen::Vector3d(x, y, 0)).head<2>();
  }
};
using SeenTags = std::map<int, SeenTag>;  // by id

cv::Point2f ToCv(const Eigen::Vector2d& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y())};
}

// Moves corners to the saddle points near them. 'reach_px': how far around a corner nothing else
// is.
void Refine(const cv::Mat& image, double reach_px, std::vector<cv::Point2f>* corners) {
  if (corners->empty()) return;
  const int half = std::clamp(static_cast<int>(reach_px), 2, 8);
  const cv::TermCriteria criteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 30, 0.01);
  cv::cornerSubPix(image, *corners, {half, half}, {-1, -1}, criteria);
}

// Finds the tags of a board one by one, without a lens.
class TagFinder {
 public:
  TagFinder(const TagBoard& board, const CameraModel& camera)
      : camera_(camera), board_(board), quads_(camera) {
    samples_.Reserve(board_.most_cells);
  }

  SeenTags Find(const cv::Mat& image) {
    SeenTags seen;
    const cv::Rect all(0, 0, image.cols, image.rows);
    quads_.Begin(image, all, &buffers_);
    // From the coarsest image to the finest: the corners of the last are the best.
    for (int pass = 0; pass < PlaneBorders::kPasses; ++pass) {
      for (const TagQuad& quad : quads_.Find(all, pass, &buffers_)) {
        if (const auto match = MatchTag(image, camera_, board_, quad, &samples_)) {
          Add(*match, quad, &seen);
        }
      }
    }
    return seen;
  }

 private:
  // Takes the corners of the quad; the match's pose determines which of them is the first.
  void Add(const TagMatch& match, const TagQuad& quad, SeenTags* seen) const {
    SeenTag one{match.tag, {}, quad.side_px};
    std::array<Eigen::Vector2d, 4> of_quad, of_tag;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d place = one.OnBoard(i);
      const Eigen::Vector3d point =
          match.camera_from_board * Eigen::Vector3d(place.x(), place.y(), 0);
      if (camera_.Project(point, &of_tag[i]) == ProjectionStatus::kOutsideModel ||
          camera_.Project(quad.corners[i], &of_quad[i]) == ProjectionStatus::kOutsideModel) {
        return;
      }
    }
    double least = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 4; ++turn) {
      double distance = 0;
      for (int i = 0; i < 4; ++i) distance += (of_tag[i] - of_quad[(i + turn) % 4]).norm();
      if (distance >= least) continue;
      least = distance;
      for (int i = 0; i < 4; ++i) one.pixels[i] = ToCv(of_quad[(i + turn) % 4]);
    }
    (*seen)[match.tag->id] = one;
  }

  CameraModel camera_;
  BoardModel board_;
  TagQuadFinder quads_;
  TagQuadBuffers buffers_;
  PadSamples samples_;
};

// Removes tags that do not lie in one plane with the others. A lens that is not known bends the
// plane: only what is far off is removed.
void KeepPlane(SeenTags* seen) {
  constexpr std::size_t kFewest = 3;
  if (seen->size() < kFewest) return;
  std::vector<cv::Point2f> on_board, pixels;
  double side_px = 0;
  for (const auto& [id, tag] : *seen) {
    side_px = std::max(side_px, tag.side_px);
    for (int i = 0; i < 4; ++i) {
      on_board.push_back(ToCv(tag.OnBoard(i)));
      pixels.push_back(tag.pixels[i]);
    }
  }
  std::vector<unsigned char> fits;
  cv::findHomography(on_board, pixels, cv::RANSAC, side_px, fits);
  if (fits.size() != pixels.size()) return;
  std::size_t i = 0;
  for (auto tag = seen->begin(); tag != seen->end(); i += 4) {
    const bool is_off = std::count(fits.begin() + i, fits.begin() + i + 4, 0) > 0;
    tag = is_off ? seen->erase(tag) : std::next(tag);
  }
}

std::vector<BoardCorner> Paired(const std::vector<Eigen::Vector2d>& on_board,
                                const std::vector<cv::Point2f>& pixels) {
  std::vector<BoardCorner> corners;
  for (std::size_t i = 0; i < pixels.size(); ++i) corners.push_back({on_board[i], pixels[i]});
  return corners;
}

// Distance of neighbouring corners where they are closest, px.
double LeastSpacing(const std::vector<cv::Point2f>& corners, int columns) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (i % columns != 0) least = std::min(least, cv::norm(corners[i] - corners[i - 1]));
  }
  return least;
}

// The quick finder of OpenCV (1 to 20 ms), and where it fails, as in a bent or blurred image, the
// sector based one in a small image: it takes 0.1 s there, in an image of 1280 x 960 up to 6 s.
std::vector<cv::Point2f> FindSquareCorners(const cv::Mat& image, const cv::Size& corners) {
  std::vector<cv::Point2f> pixels;
  constexpr int kQuick =
      cv::CALIB_CB_FAST_CHECK | cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (cv::findChessboardCorners(image, corners, pixels, kQuick)) return pixels;
  constexpr double kWidth = 640;
  const double scale = std::max(1.0, image.cols / kWidth);
  cv::Mat small = image;
  if (scale > 1) cv::resize(image, small, {}, 1 / scale, 1 / scale, cv::INTER_AREA);
  if (!cv::findChessboardCornersSB(small, corners, pixels, cv::CALIB_CB_NORMALIZE_IMAGE)) return {};
  const cv::Point2f middle(0.5F, 0.5F);  // middle of a pixel
  for (cv::Point2f& pixel : pixels) pixel = (pixel + middle) * scale - middle;
  return pixels;
}

std::vector<BoardCorner> FindChessboard(const cv::Mat& image, const LensBoard& board) {
  std::vector<cv::Point2f> pixels = FindSquareCorners(image, {board.columns, board.rows});
  constexpr double kReach = 0.4;  // share of a square
  if (!pixels.empty()) Refine(image, kReach * LeastSpacing(pixels, board.columns), &pixels);
  return Paired(board.Corners(), pixels);
}

// The squares between the tags touch their corners. In a blurred image they are one dark figure; a
// wider white takes them apart.
std::vector<BoardCorner> FindAprilGrid(const cv::Mat& image, const LensBoard& board,
                                       const CameraModel& camera) {
  TagFinder finder(board.Tags(), camera);
  SeenTags seen;
  for (const int width : {3, 5, 7}) {
    cv::Mat apart;
    cv::dilate(image, apart, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width, width}));
    SeenTags more = finder.Find(apart);
    if (more.size() > seen.size()) seen = std::move(more);
  }
  KeepPlane(&seen);
  std::vector<BoardCorner> corners;
  for (const auto& [id, tag] : seen) {
    std::vector<cv::Point2f> refined(tag.pixels.begin(), tag.pixels.end());
    constexpr double kReach = 0.1;  // less than a cell of the tag
    Refine(image, kReach * tag.side_px, &refined);
    for (int i = 0; i < 4; ++i) {
      if (cv::norm(refined[i] - tag.pixels[i]) > std::max(4.0, kReach * tag.side_px)) continue;
      corners.push_back({tag.OnBoard(i), refined[i]});
    }
  }
  return corners;
}

// The place of a corner of squares by the markers beside it; NaN where there is none.
cv::Point2f PlaceByMarkers(const SeenTags& seen, const Eigen::Vector2d& corner, double side_m) {
  cv::Point2f sum(0, 0);
  int count = 0;
  for (const auto& [id, tag] : seen) {
    const Eigen::Vector2d center = tag.tag->board_from_tag.translation.head<2>();
    if ((corner - center).lpNorm<Eigen::Infinity>() > 0.6 * side_m) continue;
    std::array<cv::Point2f, 4> on_board;
    for (int i = 0; i < 4; ++i) on_board[i] = ToCv((tag.OnBoard(i) - center) / side_m);
    const cv::Mat homography = cv::getPerspectiveTransform(on_board, tag.pixels);
    std::vector<cv::Point2f> place{ToCv((corner - center) / side_m)};
    cv::perspectiveTransform(place, place, homography);
    sum += place.front();
    ++count;
  }
  return sum / count;
}

std::vector<BoardCorner> FindSquares(const cv::Mat& image, const LensBoard& board,
                                     const CameraModel& camera) {
  TagFinder finder(board.Tags(), camera);
  SeenTags seen = finder.Find(image);
  KeepPlane(&seen);
  double side_px = std::numeric_limits<double>::infinity();  // side of the smallest marker
  for (const auto& [id, tag] : seen) side_px = std::min(side_px, tag.side_px);
  const double reach_px = 0.4 * side_px * (board.side_m - board.marker_m) / board.marker_m;
  std::vector<Eigen::Vector2d> on_board;
  std::vector<cv::Point2f> places;
  for (const Eigen::Vector2d& corner : board.Corners()) {
    const cv::Point2f place = PlaceByMarkers(seen, corner, board.side_m);
    const float margin = 10;
    if (!(place.x > margin && place.y > margin && place.x < image.cols - margin &&
          place.y < image.rows - margin)) {
      continue;
    }
    on_board.push_back(corner);
    places.push_back(place);
  }
  std::vector<cv::Point2f> refined = places;
  Refine(image, reach_px, &refined);
  std::vector<BoardCorner> corners;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (cv::norm(refined[i] - places[i]) < std::max(3.0, reach_px)) {
      corners.push_back({on_board[i], refined[i]});
    }
  }
  return corners;
}

// With an even number of rows the first square is black or white, by the age of the program that
// made the board.
std::vector<BoardCorner> FindCharuco(const cv::Mat& image, LensBoard board,
                                     const CameraModel& camera) {
  std::vector<BoardCorner> corners = FindSquares(image, board, camera);
  if (board.rows % 2 != 0) return corners;
  board.begins_white = true;
  std::vector<BoardCorner> other = FindSquares(image, board, camera);
  return other.size() > corners.size() ? other : corners;
}

std::vector<BoardCorner> FindCorners(const cv::Mat& image, const LensBoard& board,
                                     const CameraModel& camera) {
  switch (board.kind) {
    case LensBoardKind::kChessboard:
      return FindChessboard(image, board);
    case LensBoardKind::kCharuco:
      return FindCharuco(image, board, camera);
    case LensBoardKind::kAprilGrid:
      return FindAprilGrid(image, board, camera);
  }
  return {};
}

// Returns the pose of a plane by the rays to its points: the homography, made a rotation. Nothing
// when the points do not determine it.
std::optional<RigidTransform> PoseOf(const LensView& view, const CameraModel& lens) {
  double size = 0;
  for (const LensEdge& edge : view.edges) size = std::max(size, edge.on_print.norm());
  Eigen::Matrix<double, 9, 9> squares = Eigen::Matrix<double, 9, 9>::Zero();
  for (const LensEdge& edge : view.edges) {
    Eigen::Vector3d ray;
    if (lens.Unproject(edge.pixel, &ray) == ProjectionStatus::kOutsideModel) continue;
    const Eigen::Vector3d point(edge.on_print.x() / size, edge.on_print.y() / size, 1);
    const Eigen::Matrix3d cross{
        {0, -ray.z(), ray.y()}, {ray.z(), 0, -ray.x()}, {-ray.y(), ray.x(), 0}};
    Eigen::Matrix<double, 3, 9> rows;  // ray x (H point) = 0, H column by column
    for (int i = 0; i < 3; ++i) rows.middleCols<3>(3 * i) = point(i) * cross;
    squares += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(squares);
  const Eigen::Vector<double, 9> least = solver.eigenvectors().col(0);
  Eigen::Matrix3d homography = Eigen::Map<const Eigen::Matrix3d>(least.data());
  const double scale = 0.5 * (homography.col(0).norm() + homography.col(1).norm());
  if (!(scale > 1e-9)) return std::nullopt;
  homography /= scale;
  Eigen::Vector3d middle;
  if (lens.Unproject(view.edges.front().pixel, &middle) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const Eigen::Vector3d first(view.edges.front().on_print.x() / size,
                              view.edges.front().on_print.y() / size, 1);
  if ((homography * first).dot(middle) < 0) homography = -homography;
  Eigen::Matrix3d axes;
  axes << homography.leftCols<2>(), homography.col(0).cross(homography.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> turn(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = turn.matrixU() * turn.matrixV().transpose();
  return RigidTransform{Eigen::Quaterniond(rotation), size * homography.col(2)};
}

// Two edges for each corner. Their signs alternate: black that has spread over white moves no
// corner of squares.
std::vector<LensEdge> EdgesOf(const std::vector<BoardCorner>& corners) {
  std::vector<LensEdge> edges;
  double sign = 1;
  for (const BoardCorner& corner : corners) {
    const Eigen::Vector2d pixel(corner.pixel.x, corner.pixel.y);
    edges.push_back({corner.on_board, pixel, {sign, 0}});
    edges.push_back({corner.on_board, pixel, {0, sign}});
    sign = -sign;
  }
  return edges;
}

bool AreSpread(const std::vector<BoardCorner>& corners, int width_px) {
  if (corners.size() < kLeastCorners) return false;
  std::vector<cv::Point2f> pixels;
  for (const BoardCorner& corner : corners) pixels.push_back(corner.pixel);
  const cv::Size2f size = cv::minAreaRect(pixels).size;  // corners in a line determine no pose
  return std::min(size.width, size.height) > kLeastSpread * width_px;
}

// Mean distance of a view's points from where the lens shows them, px.
double MisfitOf(const LensView& view, const CameraModel& lens) {
  double sum = 0;
  for (const LensEdge& edge : view.edges) {
    Eigen::Vector2d pixel;
    const Eigen::Vector3d point =
        view.camera_from_target * Eigen::Vector3d(edge.on_print.x(), edge.on_print.y(), 0);
    if (lens.Project(point, &pixel) == ProjectionStatus::kOutsideModel) return lens.width_px();
    sum += (pixel - edge.pixel).norm();
  }
  return sum / static_cast<double>(view.edges.size());
}

}  // namespace

std::optional<LensView> FindBoard(const std::string& name, const cv::Mat& image,
                                  const LensBoard& board, const CameraIntrinsics& guess) {
  const CameraModel camera(guess);
  const std::vector<BoardCorner> corners = FindCorners(image, board, camera);
  if (!AreSpread(corners, image.cols)) return std::nullopt;
  LensView view{name, EdgesOf(corners), {}};
  const auto pose = PoseOf(view, camera);
  if (!pose) return std::nullopt;
  view.camera_from_target = *pose;
  return view;
}

std::vector<LensView> PosedBy(const CameraIntrinsics& lens, std::span<const LensView> views) {
  const CameraModel camera(lens);
  std::vector<LensView> posed;
  for (const LensView& view : views) {
    const auto pose = PoseOf(view, camera);
    if (!pose) continue;
    posed.push_back(view);
    posed.back().camera_from_target = *pose;
  }
  return posed;
}

CameraIntrinsics LikeliestLens(std::span<const CameraIntrinsics> lenses,
                               std::span<const LensView> views) {
  double least = std::numeric_limits<double>::infinity();
  CameraIntrinsics likeliest = lenses.front();
  for (const CameraIntrinsics& lens : lenses) {
    const CameraModel camera(lens);
    const std::vector<LensView> posed = PosedBy(lens, views);
    double misfit = static_cast<double>((views.size() - posed.size()) * lens.width_px);
    for (const LensView& view : posed) misfit += MisfitOf(view, camera);
    if (misfit >= least) continue;
    least = misfit;
    likeliest = lens;
  }
  return likeliest;
}

}  // namespace kestrel
