// Atomics on images: every operation, signed and unsigned, on every dimension; texels outside of the image, too.
#include "harness/case.h"
#include "harness/run.h"

namespace vitrine::cts {
namespace {

struct Dimension {
  const char* name;  ///< of GLSL's image type, without its prefix
  VkImageViewType view;
  VkExtent3D extent;
  uint32_t layers;
  const char* place;  ///< of texel i, of 64
};

constexpr Dimension kDimensions[] = {
    {"1D", VK_IMAGE_VIEW_TYPE_1D, {64, 1, 1}, 1, "i"},
    {"2D", VK_IMAGE_VIEW_TYPE_2D, {8, 8, 1}, 1, "ivec2(i & 7, i >> 3)"},
    {"3D", VK_IMAGE_VIEW_TYPE_3D, {4, 4, 4}, 1, "ivec3(i & 3, i >> 2 & 3, i >> 4)"},
    {"1DArray", VK_IMAGE_VIEW_TYPE_1D_ARRAY, {16, 1, 1}, 4, "ivec2(i & 15, i >> 4)"},
    {"2DArray", VK_IMAGE_VIEW_TYPE_2D_ARRAY, {4, 4, 1}, 4, "ivec3(i & 3, i >> 2 & 3, i >> 4)"},
    {"Cube", VK_IMAGE_VIEW_TYPE_CUBE, {4, 4, 1}, 6, "ivec3(i & 3, i >> 2 & 3, i >> 4)"},
};

void image_atomic(Run& run, const Dimension& dimension, bool is_signed, const std::string& operation) {
  ImageSpec spec;
  spec.format = is_signed ? VK_FORMAT_R32_SINT : VK_FORMAT_R32_UINT;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  spec.extent = dimension.extent;
  spec.layers = dimension.layers;
  spec.view = dimension.view;
  if (dimension.view == VK_IMAGE_VIEW_TYPE_CUBE) spec.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  const std::string type = is_signed ? "int" : "uint";
  // Own texels return what they held; an operation that commutes with itself also goes to texels of many.
  const bool compares = operation == "CompSwap", commutes = !compares && operation != "Exchange";
  const std::string at = dimension.place, call = "imageAtomic" + operation + "(image, ";
  std::string code = "layout(local_size_x = 64) in;\n#define T " + type + "\nlayout(binding = 0, r32" +
                     (is_signed ? "i" : "ui") + ") uniform " + (is_signed ? "i" : "u") + "image" + dimension.name +
                     " image;\n"
                     "layout(std430, binding = 1) readonly buffer A { T a[]; };\n"
                     "layout(std430, binding = 2) writeonly buffer R { T r[]; };\n"
                     "void main() {\n"
                     "  int i = int(gl_LocalInvocationIndex);\n  T old = T(0), x = a[i];\n";
  if (compares) code += "  if ((i & 1) != 0) old = imageLoad(image, " + at + ").x;\n";
  code += "  r[i] = " + call + at + (compares ? ", old" : "") + ", x);\n";
  if (commutes) code += "  memoryBarrierImage(); barrier();\n  i = i * 7 % 5 - 1;\n  " + call + at + ", x);\n";
  code += "}\n";
  run.note("shader", code);
  std::vector<uint32_t> words(64);
  for (uint32_t& word : words) word = run.random.bits();
  const Buffer in = run.buffer_of(words), out = run.buffer(in.size);
  const Resources res = run.resources({storage_image(0, image), storage_buffer(1, in), storage_buffer(2, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, 1);
  run.out("image", image);
  run.out("old", out);
}

const bool kCases = [] {
  for (const Dimension& dimension : kDimensions)
    for (const bool is_signed : {false, true})
      for (const char* operation : {"Add", "Min", "Max", "And", "Or", "Xor", "Exchange", "CompSwap"}) {
        if (dimension.view != VK_IMAGE_VIEW_TYPE_2D && is_signed != (operation[0] == 'M')) continue;
        AddCase("compute",
                std::string("image_atomics.") + dimension.name + (is_signed ? ".int." : ".uint.") + operation,
                [=](Run& run) { image_atomic(run, dimension, is_signed, operation); });
      }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
