#version 450
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in vec2 place[];
layout(location = 1) flat in ivec2 numbers[];
layout(location = 0) out vec2 placed;
layout(location = 1) flat out ivec2 numbered;

void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    gl_PrimitiveID = gl_PrimitiveIDIn + 10;
    placed = place[i];
    numbered = numbers[i];
    EmitVertex();
  }
}
