#version 450
layout(local_size_x = 16) in;
shared uint kept[16];

void main() {
  kept[gl_LocalInvocationIndex] = gl_LocalInvocationIndex;
}
