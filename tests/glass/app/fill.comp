#version 450
#extension GL_EXT_debug_printf : require
layout(local_size_x = 16) in;
layout(constant_id = 0) const uint count = 8;
layout(set = 0, binding = 0) buffer Data { uint data[]; };

void put(uint i) {
  data[i] = i;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i == 3) debugPrintfEXT("i is %u", i);
  if (i < count) put(i);
}
