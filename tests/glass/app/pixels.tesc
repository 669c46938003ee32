#version 450
layout(vertices = 3) out;
layout(location = 0) in vec2 place[];
layout(location = 1) in ivec2 numbers[];
layout(location = 0) out vec2 placed[];
layout(location = 1) out ivec2 numbered[];

void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  placed[gl_InvocationID] = place[gl_InvocationID];
  numbered[gl_InvocationID] = numbers[gl_InvocationID];
  for (int i = 0; i < 3; ++i)
    gl_TessLevelOuter[i] = 2.0;
  gl_TessLevelInner[0] = 2.0;
}
