#version 450
// Torus knot and floor: world-space position, normal and texture coordinates for the fragment shader.
layout(set = 0, binding = 0) uniform Camera { mat4 view_projection; vec4 eye; vec4 lights[3]; vec4 light_colors[3]; } camera;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texcoord;
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec2 uv;
void main() {
  world_position = position;
  world_normal = normal;
  uv = texcoord;
  gl_Position = camera.view_projection * vec4(position, 1.0);
}
