#version 450
layout(push_constant) uniform Push {
  vec4 color;
  float depth;
  int mode;
};
layout(location = 0) out vec2 place;
layout(location = 1) flat out ivec2 numbers;

void main() {
  vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
  if (mode == 4)
    corner = corner * 0.125 + 0.75;
  gl_Position = vec4(corner, depth, 1.0);
  place = corner;
  numbers = ivec2(gl_InstanceIndex + 3, gl_VertexIndex);
}
