#version 450
// Three coloured point lights, Phong highlights, one mip-mapped texture, distance fog.
layout(set = 0, binding = 0) uniform Camera { mat4 view_projection; vec4 eye; vec4 lights[3]; vec4 light_colors[3]; } camera;
layout(set = 0, binding = 1) uniform sampler2D albedo;
layout(push_constant) uniform Material { vec4 tint; float gloss; } material;
layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
  vec3 n = normalize(world_normal);
  vec3 to_eye = normalize(camera.eye.xyz - world_position);
  vec3 base = texture(albedo, uv).rgb * material.tint.rgb;
  vec3 sum = base * 0.06;
  for (int i = 0; i < 3; ++i) {
    vec3 d = camera.lights[i].xyz - world_position;
    float attenuation = 1.0 / (1.0 + 0.08 * dot(d, d));
    vec3 l = normalize(d);
    vec3 r = reflect(-l, n);
    float diffuse = max(dot(n, l), 0.0);
    float specular = pow(max(dot(r, to_eye), 0.0), material.gloss);
    sum += camera.light_colors[i].rgb * attenuation * (base * diffuse + vec3(specular * 0.6));
  }
  float fog = clamp((distance(camera.eye.xyz, world_position) - 6.0) / 22.0, 0.0, 1.0);
  color = vec4(mix(sum, vec3(0.05, 0.07, 0.12), fog), 1.0);
}
