#version 450
// One way of shading per value of `shading` (vitrine::demo::Shading).
layout(constant_id = 0) const int shading = 0;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec4 smooth_color;
layout(location = 1) flat in vec4 flat_color;
layout(location = 2) in vec2 perspective_uv;
layout(location = 3) noperspective in vec2 affine_uv;
layout(location = 0) out vec4 result;
vec4 checker(vec2 at) {
  ivec2 cell = ivec2(floor(at * 8.0));
  return ((cell.x + cell.y) & 1) == 0 ? smooth_color : vec4(smooth_color.rgb * 0.3, smooth_color.a);
}
void main() {
  if (shading == 0) result = smooth_color;
  if (shading == 1) result = flat_color;
  if (shading == 2) result = checker(perspective_uv);
  if (shading == 3) result = checker(affine_uv);
  if (shading == 4) result = texture(image, perspective_uv);
}
