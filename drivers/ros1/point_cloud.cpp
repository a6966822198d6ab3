// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drivers/ros1/point_fields.hpp"

namespace lxd {
namespace {

struct Cloud {
  std::uint32_t height = 0, width = 0, point_bytes = 0, row_bytes = 0;
  bool big_endian = false;
  Ros1PointFields fields;
  Ros1Reader::Bytes data;

  // Precondition: is_sound.
  [[nodiscard]] Ros1Reader::Bytes point(std::uint32_t row, std::uint32_t column) const {
    return data.subspan(std::size_t{row} * row_bytes + std::size_t{column} * point_bytes, point_bytes);
  }
};

Ros1Fault read_layout(Ros1Reader& reader, Cloud& cloud) {
  cloud.height = reader.number<std::uint32_t>();
  cloud.width = reader.number<std::uint32_t>();
  const Ros1Fault fields = read_ros1_point_fields(reader, cloud.fields);
  cloud.big_endian = reader.number<std::uint8_t>() != 0;
  cloud.point_bytes = reader.number<std::uint32_t>();
  cloud.row_bytes = reader.number<std::uint32_t>();
  cloud.data = reader.array();
  (void)reader.number<std::uint8_t>();  // is_dense: it is looked at
  const Ros1Fault end = reader.finish();
  return end != Ros1Fault::none ? end : fields;
}

// A cloud of one row is often sent with a row_step of no meaning. No row is longer than the data, so that no sum wraps.
Ros1Fault check_layout(Cloud& cloud) {
  if (cloud.big_endian) return Ros1Fault::big_endian;
  if (!cloud.fields.x || !cloud.fields.y || !cloud.fields.z) return Ros1Fault::no_coordinates;
  if (cloud.height == 0 || cloud.width == 0) return Ros1Fault::empty;
  const std::uint64_t least_row_bytes = std::uint64_t{cloud.width} * cloud.point_bytes;
  const std::uint64_t row_bytes = cloud.height == 1 ? least_row_bytes : cloud.row_bytes;
  const std::uint64_t all_bytes = row_bytes * (cloud.height - 1) + least_row_bytes;
  const bool fits = cloud.point_bytes > 0 && row_bytes >= least_row_bytes && row_bytes <= cloud.data.size() &&
                    all_bytes <= cloud.data.size() && fit_into(cloud.fields, cloud.point_bytes);
  if (!fits) return Ros1Fault::bad_layout;
  cloud.row_bytes = static_cast<std::uint32_t>(row_bytes);
  return Ros1Fault::none;
}

template <typename Function>
void for_each_point(const Cloud& cloud, Function function) {
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < cloud.width; ++column) function(cloud.point(row, column));
}

// A point's time field into nanoseconds after the header's stamp.
class PointTime {
 public:
  // None: the field's type is no time.
  static std::optional<PointTime> of(const Cloud& cloud, RigTime stamp) {
    PointTime time;
    time.field_ = cloud.fields.time;
    if (!time.field_) return time;
    const Ros1Datatype type = time.field_->datatype;
    if (type == Ros1Datatype::uint32 || type == Ros1Datatype::int32) return time;
    if (type != Ros1Datatype::float32 && type != Ros1Datatype::float64) return std::nullopt;
    double greatest = 0;
    for_each_point(cloud, [&](Ros1Reader::Bytes point) {
      const double value = std::abs(time.field_->value(point));
      if (std::isfinite(value)) greatest = std::max(greatest, value);
    });
    time.scale_ns_ = greatest > kLeastUnixTime_ns ? 1 : kNanosPerSecond_;
    if (greatest > kLeastUnixTime_s) time.zero_ = stamp;
    return time;
  }

  // Not a number, and times that no clock shows, are none.
  [[nodiscard]] std::optional<std::int64_t> offset_ns(Ros1Reader::Bytes point) const {
    if (!field_) return 0;
    const double value = field_->value(point);
    if (field_->datatype == Ros1Datatype::uint32) return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
    if (field_->datatype == Ros1Datatype::int32) return static_cast<std::int32_t>(value);
    // Whole seconds apart, so that today's times keep the digits that a double has.
    if (!(std::abs(value) * scale_ns_ < kLatest_ns)) return std::nullopt;
    const double units_per_s = kNanosPerSecond_ / scale_ns_;
    const double whole_s = std::floor(value / units_per_s);
    const auto part_ns = std::llround((value - whole_s * units_per_s) * scale_ns_);
    return static_cast<std::int64_t>(whole_s) * kNanosPerSecond + part_ns - zero_.ns();
  }

 private:
  static constexpr double kNanosPerSecond_ = 1e9;
  static constexpr double kLeastUnixTime_s = 1e6, kLeastUnixTime_ns = 1e14;  // no offset is as long, no unix time less
  static constexpr double kLatest_ns = 4.6e18;                               // half of what int64 nanoseconds hold

  std::optional<Ros1Field> field_;
  double scale_ns_ = 1;
  RigTime zero_;  // what the field's numbers are counted from, as the stamp is; else they are counted from the stamp
};

Ros1Point point_of(const Cloud& cloud, Ros1Reader::Bytes bytes) {
  Ros1Point point;
  point.x_m = static_cast<float>(cloud.fields.x->value(bytes));
  point.y_m = static_cast<float>(cloud.fields.y->value(bytes));
  point.z_m = static_cast<float>(cloud.fields.z->value(bytes));
  if (cloud.fields.intensity) point.intensity = static_cast<float>(cloud.fields.intensity->value(bytes));
  return point;
}

}  // namespace

Ros1Fault read_ros1_point_cloud(Ros1Reader::Bytes message, Ros1Scan& out) {
  out.points.clear();
  out.no_return = out.non_finite = 0;
  Ros1Reader reader(message);
  out.header = read_ros1_header(reader);
  Cloud cloud;
  if (const Ros1Fault fault = read_layout(reader, cloud); fault != Ros1Fault::none) return fault;
  if (const Ros1Fault fault = check_layout(cloud); fault != Ros1Fault::none) return fault;
  const auto time = PointTime::of(cloud, out.header.stamp);
  if (!time) return Ros1Fault::unknown_datatype;
  out.has_times = cloud.fields.time.has_value();
  for_each_point(cloud, [&](Ros1Reader::Bytes bytes) {
    Ros1Point point = point_of(cloud, bytes);
    const auto offset_ns = time->offset_ns(bytes);
    point.offset_ns = offset_ns.value_or(0);
    if (offset_ns)
      push_ros1_point(out, point);
    else
      ++out.non_finite;
  });
  return count_from_first(out);
}

}  // namespace lxd
