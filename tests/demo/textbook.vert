#version 450
// Passes colour and texture coordinates on with every kind of interpolation.
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 smooth_color;
layout(location = 1) flat out vec4 flat_color;
layout(location = 2) out vec2 perspective_uv;
layout(location = 3) noperspective out vec2 affine_uv;
void main() {
  smooth_color = color;
  flat_color = color;
  perspective_uv = uv;
  affine_uv = uv;
  gl_Position = position;
}
