#version 450
layout(local_size_x = 4, local_size_y = 4) in;
layout(set = 0, binding = 2, rgba8) uniform readonly image2D from;
layout(set = 0, binding = 3, rgba8) uniform writeonly image2D to;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  vec4 texel = imageLoad(from, at);
  imageStore(to, at, texel.bgra);
}
