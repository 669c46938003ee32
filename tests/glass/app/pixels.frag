#version 450
layout(push_constant) uniform Push {
  vec4 color;
  float depth;
  int mode;
};
layout(set = 0, binding = 0) uniform sampler2D mips;
layout(set = 0, binding = 1) uniform sampler2D resolved;
layout(location = 0) out vec4 result;
layout(location = 0) in vec2 place; layout(location = 1) flat in ivec2 numbers;
const int kDiscard = 1, kNoSamples = 2, kSecondPass = 3;

void main() {
  gl_SampleMask[0] = mode == kNoSamples ? 0 : ~0;
  result = place.x + place.y < -9.0 || numbers.y == 9 ? color.bgra : color;
  if (mode == kDiscard)
    discard;
  if (mode == kSecondPass) {
    result = textureLod(mips, gl_FragCoord.xy / 16.0, 1.0) * 0.5;
    result += texelFetch(resolved, ivec2(gl_FragCoord.xy), 0) * 0.5;
  }
}
