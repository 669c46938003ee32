#version 450
layout(local_size_x = 16) in;
layout(constant_id = 0) const uint count = 8;
layout(set = 0, binding = 0) buffer Data { uint data[]; };

// The buffer has eight words.
void main() {
  uint i = gl_GlobalInvocationID.x, last;
  if (i < count) last = i;
  data[i] = last;
}
