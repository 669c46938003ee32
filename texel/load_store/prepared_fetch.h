// An instruction that reads by integer coordinates made ready: what depends on the view and on the registers alone is
// decided once, not for every wave. It stays valid as long as these do and the view is not changed.
#pragma once

#include "texel/sampler.h"

namespace vitrine::texel {

/// How a result comes of a texel's words.
struct FetchedField {
  base::WaveRegister* to = nullptr;
  std::uint8_t word = 0;   ///< of the texel
  std::uint8_t shift = 0;  ///< of the channel's lowest bit in it
  std::uint8_t bits = 0;
};

/// A coordinate, the number of texels along it and their distance in bytes.
struct FetchedAxis {
  const base::WaveRegister* coord = nullptr;
  std::int32_t size = 0;
  std::int32_t stride = 0;
};

/// Texels of one level, looked up by a register per coordinate, where neighbouring lanes may read neighbours.
struct PreparedFetch {
  /// For all lanes. False where the wave's first lanes read no neighbours; then nothing is written.
  using Kernel = bool (*)(const PreparedFetch&);

  Kernel kernel = nullptr;  ///< null: there is none, and fetch() is general
  const std::byte* base = nullptr;
  std::array<FetchedAxis, 5> axis{};  ///< the first is that of adjacent texels
  std::array<FetchedField, 4> field{};
  std::uint32_t axis_count = 0, field_count = 0;
  std::array<base::WaveRegister*, 4> constant_to{};  ///< results that are the same for all texels
  std::array<std::uint32_t, 4> constant{};
  std::uint32_t constant_count = 0;
};

PreparedFetch prepare_fetch(const ImageView& view, const FetchRequest& request, const SampleResult& result);
PreparedFetch prepare_fetch(const BufferTexelView& view, const base::WaveRegister& index, const SampleResult& result);

}  // namespace vitrine::texel
