// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/point_fields.hpp"

#include <algorithm>
#include <array>

namespace lxd {
namespace {

std::uint32_t bytes_of(Ros1Datatype datatype) {
  static constexpr std::array<std::uint32_t, 9> kBytes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes.at(static_cast<std::size_t>(datatype));
}

template <typename Number>
double number_at(Ros1Reader::Bytes bytes) {
  return static_cast<double>(Ros1Reader(bytes).number<Number>());
}

// The wanted fields by their names, a better one before a worse one for the same: `rank` tells.
struct Wanted {
  std::string_view name;
  std::optional<Ros1Field> Ros1PointFields::*field;
  int rank;
};
constexpr std::array<Wanted, 10> kWanted{{{"x", &Ros1PointFields::x, 0},
                                          {"y", &Ros1PointFields::y, 0},
                                          {"z", &Ros1PointFields::z, 0},
                                          {"intensity", &Ros1PointFields::intensity, 0},
                                          {"reflectivity", &Ros1PointFields::intensity, 1},
                                          {"t", &Ros1PointFields::time, 0},
                                          {"offset_time", &Ros1PointFields::time, 1},
                                          {"time", &Ros1PointFields::time, 2},
                                          {"timestamp", &Ros1PointFields::time, 3},
                                          {"time_stamp", &Ros1PointFields::time, 4}}};

constexpr int kNoRank = static_cast<int>(kWanted.size());

}  // namespace

double Ros1Field::value(Ros1Reader::Bytes point) const {
  const Ros1Reader::Bytes bytes = point.subspan(offset, bytes_of(datatype));
  switch (datatype) {
    case Ros1Datatype::int8:
      return number_at<std::int8_t>(bytes);
    case Ros1Datatype::uint8:
      return number_at<std::uint8_t>(bytes);
    case Ros1Datatype::int16:
      return number_at<std::int16_t>(bytes);
    case Ros1Datatype::uint16:
      return number_at<std::uint16_t>(bytes);
    case Ros1Datatype::int32:
      return number_at<std::int32_t>(bytes);
    case Ros1Datatype::uint32:
      return number_at<std::uint32_t>(bytes);
    case Ros1Datatype::float32:
      return number_at<float>(bytes);
    case Ros1Datatype::float64:
      return number_at<double>(bytes);
  }
  return 0;
}

Ros1Fault read_ros1_point_fields(Ros1Reader& reader, Ros1PointFields& out) {
  out = {};
  std::array<int, kWanted.size()> ranks{};  // by the first that is wanted for the same
  ranks.fill(kNoRank);
  Ros1Fault fault = Ros1Fault::none;
  const auto count = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && reader.ok(); ++i) {
    const std::string_view name = reader.text();
    const auto offset = reader.number<std::uint32_t>();
    const auto datatype = reader.number<std::uint8_t>();
    (void)reader.number<std::uint32_t>();  // elements: the first is what is meant
    const auto* const wanted = std::ranges::find(kWanted, name, &Wanted::name);
    if (wanted == kWanted.end()) continue;
    const auto same = [&](const Wanted& other) { return other.field == wanted->field; };
    int& rank = ranks.at(static_cast<std::size_t>(std::ranges::find_if(kWanted, same) - kWanted.begin()));
    if (wanted->rank >= rank) continue;
    rank = wanted->rank;
    const bool known = datatype >= 1 && datatype <= static_cast<std::uint8_t>(Ros1Datatype::float64);
    if (!known) fault = Ros1Fault::unknown_datatype;
    if (known) out.*(wanted->field) = Ros1Field{offset, static_cast<Ros1Datatype>(datatype)};
  }
  return fault;
}

bool fit_into(const Ros1PointFields& fields, std::uint32_t point_bytes) {
  const auto fits = [&](const std::optional<Ros1Field>& field) {
    return !field || std::uint64_t{field->offset} + bytes_of(field->datatype) <= point_bytes;
  };
  return fits(fields.x) && fits(fields.y) && fits(fields.z) && fits(fields.intensity) && fits(fields.time);
}

}  // namespace lxd
