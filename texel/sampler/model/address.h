// Texel selection along one axis: the wrap arithmetic of the reference, scalar (lavapipe-texture-blend.md A3, A7).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/numeric.h"
#include "texel/sampler/plan.h"

namespace vitrine::texel {

/// One axis of one level, seen by one lane.
struct Axis {
  Address address = Address::kRepeat;
  bool pot = false;
  bool normalized = true;
  std::int32_t size = 1;
  std::int32_t offset = 0;
  bool has_offset = false;
};

/// Two neighbours and the weight of the second. Border coordinates may lie outside.
struct Taps {
  std::int32_t first = 0;
  std::int32_t second = 0;
  float weight = 0;
};

/// The same in 8 fractional bits.
struct ByteTaps {
  std::int32_t first = 0;
  std::int32_t second = 0;
  std::int32_t weight = 0;
};

inline std::int32_t wrapping_add(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Largest float below 1: a fraction may round up to 1, which would select the texel after the last.
inline constexpr float kBelowOne = 0.99999994f;

inline float axis_size(const Axis& axis) { return static_cast<float>(axis.size); }

/// s in texels.
inline float scaled(const Axis& axis, float s) { return axis.normalized ? s * axis_size(axis) : s; }
inline float plus_offset(const Axis& axis, float c) {
  return axis.has_offset ? c + static_cast<float>(axis.offset) : c;
}

/// s with the offset added in normalised units.
inline float shifted(const Axis& axis, float s) {
  return axis.has_offset ? s + static_cast<float>(axis.offset) / axis_size(axis) : s;
}

/// Signed distance to the nearest even integer, times 1: the triangle wave before its absolute value.
inline float signed_mirror(float s) {
  float c = s * 0.5f;
  c = c - std::nearbyintf(c);
  return c + c;
}
inline float mirror(float s) { return base::max_second(std::fabs(signed_mirror(s)), 0.0f); }

inline std::int32_t floor_to_int(float c) { return base::truncate_to_int(std::floor(c)); }

/// min as unsigned integers: negative (out of range) values become the last texel.
inline std::int32_t min_unsigned(std::int32_t i, std::int32_t last) {
  return static_cast<std::int32_t>(std::min(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(last)));
}

inline std::int32_t repeat_nearest_npot(const Axis& axis, float s) {
  float c = shifted(axis, s);
  c = c - std::floor(c);
  return base::truncate_to_int(base::min_second(c, kBelowOne) * axis_size(axis));
}

/// AoS NEAREST; REPEAT and CLAMP_TO_EDGE only.
inline std::int32_t nearest_bytes(const Axis& axis, float s) {
  if (axis.address == Address::kRepeat && !axis.pot) return repeat_nearest_npot(axis, s);
  const std::int32_t i = wrapping_add(floor_to_int(scaled(axis, s)), axis.offset);
  return axis.address == Address::kRepeat ? i & (axis.size - 1) : std::clamp(i, 0, axis.size - 1);
}

/// AoS LINEAR.
inline ByteTaps linear_bytes(const Axis& axis, float s) {
  ByteTaps taps;
  const std::int32_t last = axis.size - 1;
  if (axis.address == Address::kRepeat && !axis.pot) {
    float c = shifted(axis, s);
    c = c - std::floor(c);
    c = c * axis_size(axis);
    const std::int32_t k = wrapping_add(base::round_to_int(c * 256.0f), -128);
    taps.weight = k & 255;
    taps.first = (k >> 8) < 0 ? last : std::min(k >> 8, last);
    taps.second = taps.first == last ? 0 : taps.first + 1;
    return taps;
  }
  const float scale = axis.normalized ? static_cast<float>(axis.size << 8) : 256.0f;
  const std::int32_t q = wrapping_add(base::round_to_int(s * scale), -128);
  const std::int32_t i = (q >> 8) + axis.offset;
  taps.weight = q & 255;
  if (axis.address == Address::kRepeat) {
    taps.first = i & last;
    taps.second = taps.first == last ? 0 : taps.first + 1;
  } else {
    taps.first = std::clamp(i, 0, last);
    taps.second = i >= 0 && i < last ? taps.first + 1 : taps.first;
  }
  return taps;
}

/// SoA NEAREST. CLAMP_TO_BORDER may return coordinates outside.
inline std::int32_t nearest_texel(const Axis& axis, float s) {
  const std::int32_t last = axis.size - 1;
  switch (axis.address) {
    case Address::kRepeat:
      if (!axis.pot) return repeat_nearest_npot(axis, s);
      return wrapping_add(floor_to_int(scaled(axis, s)), axis.offset) & last;
    case Address::kClamp:
      return std::clamp(base::truncate_to_int(plus_offset(axis, scaled(axis, s))), 0, last);
    case Address::kBorder:
      return wrapping_add(floor_to_int(scaled(axis, s)), axis.offset);
    case Address::kMirror:
      return std::min(base::truncate_to_int(mirror(shifted(axis, s)) * axis_size(axis)), last);
    case Address::kMirrorClamp:
      return min_unsigned(base::truncate_to_int(std::fabs(plus_offset(axis, scaled(axis, s)))), last);
  }
  return 0;
}

inline Taps split(float c) {
  const float floor = std::floor(c);
  const std::int32_t i = base::truncate_to_int(floor);
  return {i, wrapping_add(i, 1), c - floor};
}

/// SoA LINEAR.
inline Taps linear_texels(const Axis& axis, float s) {
  const std::int32_t last = axis.size - 1;
  switch (axis.address) {
    case Address::kRepeat: {
      if (axis.pot) {
        Taps taps = split(plus_offset(axis, scaled(axis, s) - 0.5f));
        taps.first &= last;
        taps.second &= last;
        return taps;
      }
      float c = shifted(axis, s);
      c = c - std::floor(c);
      c = c * axis_size(axis) - 0.5f;
      Taps taps = split(c);
      if (!(c >= 0.0f)) taps.first = last;
      taps.second = taps.first == last ? 0 : taps.first + 1;
      return taps;
    }
    case Address::kClamp:
    case Address::kMirrorClamp: {
      float c = plus_offset(axis, scaled(axis, s));
      if (axis.address == Address::kMirrorClamp) c = std::fabs(c);
      c = base::min_second(c, axis_size(axis)) - 0.5f;
      Taps taps = split(base::max_second(c, 0.0f));
      taps.second = std::min(taps.second, last);
      return taps;
    }
    case Address::kBorder:
      return split(plus_offset(axis, scaled(axis, s)) - 0.5f);
    case Address::kMirror: {
      Taps taps = split(mirror(shifted(axis, s)) * axis_size(axis) - 0.5f);
      taps.first = std::max(taps.first, 0);
      taps.second = std::min(taps.second, last);
      return taps;
    }
  }
  return {};
}

/// The two texels of a gather; no weight.
inline Taps gather_texels(const Axis& axis, float s) {
  const std::int32_t last = axis.size - 1;
  const auto fold = [last](std::int32_t i) { return std::min(i < 0 ? ~i : i, last); };
  switch (axis.address) {
    case Address::kClamp: {
      const float c = base::max_second(base::min_second(plus_offset(axis, scaled(axis, s)), axis_size(axis)), 0.0f);
      return {base::truncate_to_int(c - 0.5f), std::min(base::truncate_to_int(c + 0.5f), last), 0};
    }
    case Address::kMirror: {
      const Taps taps = split(signed_mirror(shifted(axis, s)) * axis_size(axis) - 0.5f);
      return {fold(taps.first), fold(taps.second), 0};
    }
    case Address::kMirrorClamp: {
      const Taps taps = split(plus_offset(axis, scaled(axis, s)) - 0.5f);
      return {fold(taps.first), fold(taps.second), 0};
    }
    default:
      return linear_texels(axis, s);
  }
}

}  // namespace vitrine::texel
