#version 450
layout(triangles, equal_spacing) in;
layout(location = 0) in vec2 placed[];
layout(location = 1) in ivec2 numbered[];
layout(location = 0) out vec2 place;
layout(location = 1) flat out ivec2 numbers;

void main() {
  gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +
                gl_TessCoord.z * gl_in[2].gl_Position;
  place = gl_TessCoord.x * placed[0] + gl_TessCoord.y * placed[1] + gl_TessCoord.z * placed[2];
  numbers = numbered[0];
}
