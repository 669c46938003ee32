// Angles in binary32, bit for bit as the reference's C library has them (glibc 2.36: atan2f, sinf, cosf): others, and
// later ones of its own, give other last bits.
#pragma once

namespace vitrine::base {

/// The angle of (x, y) from the x axis, -pi to pi. The quotient is brought near one of four known angles, where a
/// polynomial of degree 23 does the rest: the method of fdlibm.
float atan2(float y, float x);

struct Direction {
  float cos = 1, sin = 0;
};
/// Of an angle of at most pi and a little: polynomials in binary64 after the nearest multiple of pi / 2 is taken off.
Direction direction_of(float angle);

}  // namespace vitrine::base
