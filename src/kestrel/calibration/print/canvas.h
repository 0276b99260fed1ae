// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cairo.h>
#include <functional>
#include <memory>
#include <string>

#include <Eigen/Core>

namespace kestrel {

// Pages of vector drawings in metres: x to the right, y down from the upper left corner.
class Canvas {
 public:
  enum class Format { kPdf, kSvg };

  // Writes 'file'; an SVG has one page. The content of the file does not depend on the time.
  Canvas(Format format, const std::string& file, const Eigen::Vector2d& page_size_m);

  // Begins another page.
  void NextPage();

  // Writes the drawing. Throws InputError when the file cannot be written.
  void Finish();

  struct Ink {
    double red, green, blue;
  };
  void SetInk(const Ink& ink);
  void Fill();  // fills the path
  void Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m);
  void Rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size);  // adds to the path

  // 'align': the text begins at 'base' (0), is centred on it (0.5) or ends there (1).
  void Text(const Eigen::Vector2d& base, double height_m, const std::string& text,
            double align = 0);

  // Draws in coordinates that are moved, rotated (rad, clockwise as seen) and scaled.
  void Within(const Eigen::Vector2d& origin, double angle, double scale,
              const std::function<void()>& draw);

  cairo_t* cairo() { return cairo_.get(); }

 private:
  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };

  std::string file_;
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> cairo_;
};

}  // namespace kestrel
