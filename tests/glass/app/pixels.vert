#version 450
layout(push_constant) uniform Push {
  vec4 color;
  float depth;
  int mode;
};

void main() {
  vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0;
  if (mode == 4)
    corner = corner * 0.125 + 0.75;
  gl_Position = vec4(corner, depth, 1.0);
}
