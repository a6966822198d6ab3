// SPDX-License-Identifier: Apache-2.0
// The tables that packets are read and written by: fields stay inside their block and out of each other's way.
#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "drivers/ouster/bit_field.hpp"
#include "drivers/ouster/block_field.hpp"
#include "drivers/ouster/packet_format.hpp"

namespace lxd::drivers_bit_field_test {
namespace {

std::vector<BitField> channel_fields(const OusterChannelFields& f) {
  return {f.range_mm,  f.flags,  f.reflectivity,  f.signal,  f.near_ir,
          f.range2_mm, f.flags2, f.reflectivity2, f.signal2, f.window};
}

TEST(BitField, WhatIsSetIsReadAndItsNeighboursStay) {
  EXPECT_TRUE(rc::check([] {
    const auto bits = *rc::gen::inRange(1, 57);
    const auto first = *rc::gen::inRange(0, 128 - bits + 1);
    const BitField field{static_cast<std::uint16_t>(first), static_cast<std::uint8_t>(bits)};
    const auto before = *rc::gen::container<std::array<std::uint8_t, 16>>(rc::gen::arbitrary<std::uint8_t>());
    const auto value = *rc::gen::arbitrary<std::uint64_t>() & field.mask();
    auto block = before;
    field.set(block.data(), value);
    RC_ASSERT(field.get(block.data()) == value);
    for (int bit = 0; bit < 128; ++bit) {
      if (bit >= first && bit < first + bits) continue;
      RC_ASSERT((block[bit / 8] >> (bit % 8) & 1) == (before[bit / 8] >> (bit % 8) & 1));
    }
  }));
}

TEST(BitField, WholeBytesAreLittleEndian) {
  const std::array<std::uint8_t, 9> block{0xFF, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(bytes_at(1, 8).get(block.data()), 0x0807060504030201ULL);
  EXPECT_EQ(bytes_at(1, 3).get(block.data()), 0x030201U);
}

TEST(BitField, CoarseUnitsAreScaledToTheFineOne) {
  const std::array<std::uint8_t, 2> block{0x03, 0x80};
  EXPECT_EQ((BitField{0, 15, 3}).get(block.data()), 24U);
}

// Given blocks of any bytes and nothing behind them, then every field of every profile is read as by BitField.
TEST(BlockField, ReadsWhatBitFieldReads) {
  constexpr std::size_t kBlocks = 5;
  for (const OusterProfile& profile : ouster_profiles()) {
    std::vector<std::uint8_t> blocks(kBlocks * profile.channel_bytes);
    for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = static_cast<std::uint8_t>(151 * i + 83);
    for (const BitField& field : channel_fields(profile.fields)) {
      if (!field.present()) continue;
      std::array<std::uint32_t, kBlocks> values{};
      BlockField(field, profile.channel_bytes).get(blocks.data(), profile.channel_bytes, kBlocks, values.data());
      for (std::size_t i = 0; i < kBlocks; ++i)
        EXPECT_EQ(values[i], field.get(&blocks[i * profile.channel_bytes])) << profile.name << " " << field.first_bit;
    }
  }
}

TEST(OusterProfiles, FieldsLieInsideTheirBlockAndApart) {
  for (const OusterProfile& profile : ouster_profiles()) {
    std::vector<bool> taken(profile.channel_bytes * 8);
    for (const BitField& field : channel_fields(profile.fields)) {
      for (int bit = field.first_bit; bit < field.first_bit + field.bits; ++bit) {
        ASSERT_LT(static_cast<std::size_t>(bit), taken.size()) << profile.name;
        EXPECT_FALSE(taken[bit]) << profile.name << " bit " << bit;
        taken[bit] = true;
      }
    }
  }
}

// Sizes of datagrams in captures, and those that the SDK computes.
TEST(OusterProfiles, PacketSizesAreThoseOnTheWire) {
  const auto bytes = [](const char* profile, std::uint16_t rows) {
    return OusterPacketFormat{find_ouster_profile(profile), 16, rows}.packet_bytes();
  };
  EXPECT_EQ(bytes("LEGACY", 32), 6464U);
  EXPECT_EQ(bytes("LEGACY", 64), 12608U);
  EXPECT_EQ(bytes("LEGACY", 128), 24896U);
  EXPECT_EQ(bytes("RNG19_RFL8_SIG16_NIR16", 128), 24832U);
  EXPECT_EQ(bytes("RNG19_RFL8_SIG16_NIR16_DUAL", 32), 8448U);
  EXPECT_EQ(bytes("RNG15_RFL8_NIR8", 128), 8448U);
  EXPECT_EQ(bytes("FUSA_RNG15_RFL8_NIR8_DUAL", 128), 16640U);
  EXPECT_EQ(bytes("FIVE_WORD_PIXEL", 32), 64U + 16 * (12 + 32 * 20));
}

TEST(OusterProfiles, UnknownProfileIsNone) { EXPECT_EQ(find_ouster_profile("RNG20"), nullptr); }

}  // namespace
}  // namespace lxd::drivers_bit_field_test
