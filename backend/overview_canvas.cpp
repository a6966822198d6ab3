// SPDX-License-Identifier: Apache-2.0
// Drawing with Cairo.
#include "backend/overview_canvas.hpp"

#include <numbers>

#include <fmt/format.h>

#include "backend/part_file.hpp"

namespace lxd {
namespace {

Colour mean_of(const Raster& raster, int x0, int y0, int size) {
  Colour sum = Colour::Zero();
  for (int y = y0; y < y0 + size; ++y)
    for (int x = x0; x < x0 + size; ++x) sum += raster.covered(x, y) ? raster.colour(x, y) : kBackground;
  return sum / static_cast<float>(size * size);
}

// Cairo's RGB24: 0x00RRGGBB in the machine's own byte order.
std::uint32_t packed(const Colour& colour) {
  const auto byte = [](float value) { return static_cast<std::uint32_t>(std::clamp(value, 0.F, 1.F) * 255.F + 0.5F); };
  return byte(colour.x()) << 16U | byte(colour.y()) << 8U | byte(colour.z());
}

cairo_status_t write_bytes(void* file, const unsigned char* data, unsigned int length) {
  auto* const out = static_cast<PartFile*>(file);
  out->write(std::as_bytes(std::span(data, length)));
  return out->ok() ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px)),
      cairo_(cairo_create(surface_.get())) {
  set(kBackground);
  cairo_paint(cairo_.get());
  cairo_set_line_cap(cairo_.get(), CAIRO_LINE_CAP_ROUND);
}

void Canvas::set(const Colour& c, double opacity) { cairo_set_source_rgba(cairo_.get(), c.x(), c.y(), c.z(), opacity); }

void Canvas::image(const Raster& raster, const Eigen::Vector2i& corner_px, int supersampling) {
  cairo_surface_flush(surface_.get());
  unsigned char* const data = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  for (int y = 0; y < raster.height() / supersampling; ++y) {
    auto* const row =
        reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(stride) * (corner_px.y() + y));
    for (int x = 0; x < raster.width() / supersampling; ++x)
      row[corner_px.x() + x] = packed(mean_of(raster, x * supersampling, y * supersampling, supersampling));
  }
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width_px, const Colour& colour,
                  double opacity) {
  set(colour, opacity);
  cairo_set_line_width(cairo_.get(), width_px);
  cairo_move_to(cairo_.get(), a.x(), a.y());
  cairo_line_to(cairo_.get(), b.x(), b.y());
  cairo_stroke(cairo_.get());
}

void Canvas::trace(std::span<const Eigen::Vector2d> points) {
  cairo_new_path(cairo_.get());
  for (const Eigen::Vector2d& p : points) cairo_line_to(cairo_.get(), p.x(), p.y());
}

void Canvas::polyline(std::span<const Eigen::Vector2d> points, double width_px, const Colour& colour, double opacity) {
  set(colour, opacity);
  cairo_set_line_width(cairo_.get(), width_px);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
  trace(points);
  cairo_stroke(cairo_.get());
}

void Canvas::area(std::span<const Eigen::Vector2d> outline, const Colour& colour, double opacity) {
  set(colour, opacity);
  trace(outline);
  cairo_fill(cairo_.get());
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius_px, const Colour& colour) {
  set(colour);
  cairo_arc(cairo_.get(), centre.x(), centre.y(), radius_px, 0, 2 * std::numbers::pi);
  cairo_fill(cairo_.get());
}

void Canvas::select_font(double size_px, bool bold) {
  cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_.get(), size_px);
}

double Canvas::text_width_px(const std::string& text, double size_px, bool bold) {
  select_font(size_px, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const Eigen::Vector2d& baseline, const std::string& text, double size_px, const Colour& colour,
                  Anchor anchor, bool bold) {
  const double share = anchor == Anchor::left ? 0 : anchor == Anchor::middle ? 0.5 : 1;
  const double width_px = text_width_px(text, size_px, bold);  // selects the font
  set(colour);
  cairo_move_to(cairo_.get(), baseline.x() - share * width_px, baseline.y());
  cairo_show_text(cairo_.get(), text.c_str());
}

void Canvas::clip(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) {
  cairo_save(cairo_.get());
  cairo_rectangle(cairo_.get(), corner.x(), corner.y(), size.x(), size.y());
  cairo_clip(cairo_.get());
}

void Canvas::unclip() { cairo_restore(cairo_.get()); }

Status Canvas::write_png(const std::filesystem::path& path) {
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  const cairo_status_t written = cairo_surface_write_to_png_stream(surface_.get(), write_bytes, &*file);
  if (!file->ok()) return file->status();
  if (written != CAIRO_STATUS_SUCCESS)
    return Error{fmt::format("{}: the picture cannot be made: {}", path.string(), cairo_status_to_string(written))};
  return file->commit();
}

}  // namespace lxd
