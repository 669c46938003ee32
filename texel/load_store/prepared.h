// An instruction that reads or writes by integer coordinates made ready: what depends on the view and on the registers
// alone is decided once, not for every wave. It stays valid as long as these do and the view is not changed.
#pragma once

#include "texel/sampler.h"

namespace vitrine::texel {

/// A coordinate, the number of texels along it and their distance in bytes.
struct TexelAxis {
  const base::WaveRegister* coord = nullptr;
  std::int32_t size = 0;
  std::int32_t stride = 0;
};

/// Texels of one level, named by a register per coordinate.
struct TexelGrid {
  std::byte* base = nullptr;
  std::array<TexelAxis, 5> axis{};  ///< the first is that of adjacent texels
  std::uint32_t axis_count = 0;
};

/// A channel of a texel that lies in words, and a register with its values.
template <class Register>
struct TexelField {
  Register* values = nullptr;
  Channel channel;        ///< its offset is that in the word
  std::uint8_t word = 0;  ///< of the texel
};

/// Texels that become words, words that become results. The words are as many as a texel has.
struct PreparedFetch {
  using Load = void (*)(const TexelGrid&, base::LaneMask active, base::WaveRegister words[4]);
  using Convert = void (*)(const PreparedFetch&, base::LaneMask active, const base::WaveRegister words[4]);

  Load load = nullptr;  ///< null: there is none, and fetch() is general
  Convert convert = nullptr;
  TexelGrid grid;
  std::array<TexelField<base::WaveRegister>, 4> field{};
  std::array<base::WaveRegister*, 4> constant_to{};  ///< results that are the same for all texels
  std::array<std::uint32_t, 4> constant{};
  std::uint32_t field_count = 0, constant_count = 0;

  bool is_ready() const { return load != nullptr; }
};

/// The other way round.
struct PreparedStore {
  using Encode = void (*)(const PreparedStore&, base::WaveRegister words[4]);
  using Store = void (*)(const TexelGrid&, base::LaneMask active, const base::WaveRegister words[4]);

  Encode encode = nullptr;  ///< null: there is none, and store() is general
  Store store = nullptr;
  TexelGrid grid;
  std::array<TexelField<const base::WaveRegister>, 4> field{};  ///< those that are stored as 0 are left out
  std::uint32_t field_count = 0, word_count = 0;

  bool is_ready() const { return encode != nullptr; }
};

/// Of what is ready. Results may be the registers of coordinates.
inline void fetch(const PreparedFetch& prepared, base::LaneMask active) {
  base::WaveRegister words[4];
  prepared.load(prepared.grid, active, words);
  prepared.convert(prepared, active, words);
}

/// In increasing order of lanes.
inline void store(const PreparedStore& prepared, base::LaneMask active) {
  base::WaveRegister words[4];
  prepared.encode(prepared, words);
  prepared.store(prepared.grid, active, words);
}

}  // namespace vitrine::texel
