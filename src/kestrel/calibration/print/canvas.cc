// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr double kPointsPerMeter = 72 / 0.0254;
constexpr double kTolerance = 0.01;  // tolerance of curves, points

cairo_surface_t* MakeSurface(Canvas::Format format, const std::string& file,
                             const Eigen::Vector2d& size) {
  if (format == Canvas::Format::kSvg) {
    cairo_surface_t* const drawing = cairo_svg_surface_create(file.c_str(), size.x(), size.y());
    // Some versions of Cairo write a size without a unit, which is read as pixels.
    cairo_svg_surface_set_document_unit(drawing, CAIRO_SVG_UNIT_PT);
    return drawing;
  }
  cairo_surface_t* const surface = cairo_pdf_surface_create(file.c_str(), size.x(), size.y());
  // The default is the time of writing.
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, "Kestrel landing pattern");
  return surface;
}

}  // namespace

Canvas::Canvas(Format format, const std::string& file, const Eigen::Vector2d& page_size_m)
    : file_(file),
      surface_(MakeSurface(format, file, kPointsPerMeter * page_size_m)),
      cairo_(cairo_create(surface_.get())) {
  cairo_scale(cairo(), kPointsPerMeter, kPointsPerMeter);
  cairo_set_tolerance(cairo(), kTolerance);
  cairo_select_font_face(cairo(), "Helvetica", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

void Canvas::NextPage() { cairo_show_page(cairo()); }

void Canvas::Finish() {
  const cairo_status_t drawn = cairo_status(cairo());
  cairo_surface_finish(surface_.get());
  const cairo_status_t written = cairo_surface_status(surface_.get());
  const cairo_status_t status = drawn != CAIRO_STATUS_SUCCESS ? drawn : written;
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw InputError(fmt::format("{}: cannot be written: {}", file_, cairo_status_to_string(status)));
}

void Canvas::SetInk(const Ink& ink) { cairo_set_source_rgb(cairo(), ink.red, ink.green, ink.blue); }

void Canvas::Fill() { cairo_fill(cairo()); }

void Canvas::Line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m) {
  cairo_move_to(cairo(), from.x(), from.y());
  cairo_line_to(cairo(), to.x(), to.y());
  cairo_set_line_width(cairo(), width_m);
  cairo_stroke(cairo());
}

void Canvas::Rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) {
  cairo_rectangle(cairo(), corner.x(), corner.y(), size.x(), size.y());
}

void Canvas::Text(const Eigen::Vector2d& base, double height_m, const std::string& text,
                  double align) {
  cairo_set_font_size(cairo(), height_m);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo(), text.c_str(), &extents);
  cairo_move_to(cairo(), base.x() - align * extents.x_advance, base.y());
  cairo_show_text(cairo(), text.c_str());
}

void Canvas::Within(const Eigen::Vector2d& origin, double angle, double scale,
                    const std::function<void()>& draw) {
  cairo_save(cairo());
  cairo_translate(cairo(), origin.x(), origin.y());
  cairo_rotate(cairo(), angle);
  cairo_scale(cairo(), scale, scale);
  draw();
  cairo_restore(cairo());
}

}  // namespace kestrel
