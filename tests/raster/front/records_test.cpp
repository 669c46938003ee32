// Records to registers and back.
#include "raster/front/records.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/simd_targets.h"

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kStride = 7;

/// 64 records of words that are all different.
std::vector<std::uint32_t> numbered() {
  std::vector<std::uint32_t> words(base::kWaveWidth * kStride);
  std::iota(words.begin(), words.end(), 1u);
  return words;
}

TEST(Records, LoadTakesWordsOfEachRecord) {
  const std::vector<std::uint32_t> words = numbered();
  base::for_each_simd_target([&] {
    for (const std::uint32_t lanes : {1u, 3u, 4u, 6u, 64u}) {
      const std::byte* at[base::kWaveWidth];
      for (std::uint32_t i = 0; i < lanes; ++i)
        at[i] = reinterpret_cast<const std::byte*>(words.data() + (i * 37 % base::kWaveWidth) * kStride);
      base::WaveRegister reg[3];
      std::uint32_t* const to[4] = {reg[0].lane, nullptr, reg[1].lane, reg[2].lane};
      load_records(at, lanes, to);
      for (std::uint32_t i = 0; i < lanes; ++i) {
        const std::uint32_t* const record = words.data() + (i * 37 % base::kWaveWidth) * kStride;
        EXPECT_EQ(reg[0].lane[i], record[0]) << i;
        EXPECT_EQ(reg[1].lane[i], record[2]) << i;
        EXPECT_EQ(reg[2].lane[i], record[3]) << i;
      }
    }
  });
}

TEST(Records, StoreIsTheOpposite) {
  const std::vector<std::uint32_t> words = numbered();
  base::for_each_simd_target([&] {
    for (const std::uint32_t lanes : {2u, 5u, 64u}) {
      std::vector<std::uint32_t> out(words.size());
      const std::uint32_t* const from[4] = {words.data(), words.data() + 64, words.data() + 128, words.data() + 192};
      store_records(from, lanes, out.data(), kStride);
      for (std::uint32_t i = 0; i < lanes; ++i)
        for (std::uint32_t c = 0; c < 4; ++c) EXPECT_EQ(out[i * kStride + c], words[c * 64 + i]) << i;
    }
  });
}

}  // namespace
}  // namespace vitrine::raster
