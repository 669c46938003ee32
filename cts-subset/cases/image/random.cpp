// Random loads, stores and atomics of storage images of every format and shape, in several stages, some of them beyond
// the image.
#include <cstring>

#include "cases/api/random_transfer.h"
#include "cases/common/storage_format.h"
#include "cases/common/work_items.h"
#include "harness/case.h"

namespace vitrine::cts {
namespace {

struct Shape {
  VkImageViewType view;
  const char* name;  ///< of GLSL's image type
  uint32_t coordinates;
  const char* place;  ///< of texel i, given vec3 `size`: columns, rows, layers or slices
};
constexpr Shape kShapes[] = {
    {VK_IMAGE_VIEW_TYPE_1D, "1D", 1, "i"},
    {VK_IMAGE_VIEW_TYPE_1D_ARRAY, "1DArray", 2, "ivec2(i % size.x, i / size.x)"},
    {VK_IMAGE_VIEW_TYPE_2D, "2D", 2, "ivec2(i % size.x, i / size.x)"},
    {VK_IMAGE_VIEW_TYPE_2D_ARRAY, "2DArray", 3, "ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y))"},
    {VK_IMAGE_VIEW_TYPE_3D, "3D", 3, "ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y))"},
    {VK_IMAGE_VIEW_TYPE_CUBE, "Cube", 3, "ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y))"},
    {VK_IMAGE_VIEW_TYPE_CUBE_ARRAY, "CubeArray", 3, "ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y))"}};

/// A level of an image of a shape; a level of a cube has all of its faces.
struct Level {
  Image image;  ///< with a view of the level
  uint32_t size[3];

  uint32_t texels() const { return size[0] * size[1] * size[2]; }
};

Level random_level(Run& run, const Shape& shape, VkFormat format) {
  Random& random = run.random;
  ImageSpec spec;
  spec.format = format;
  spec.view = shape.view;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  const bool cube = shape.view == VK_IMAGE_VIEW_TYPE_CUBE || shape.view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  const bool flat = shape.view == VK_IMAGE_VIEW_TYPE_1D || shape.view == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
  const bool array = shape.view == VK_IMAGE_VIEW_TYPE_1D_ARRAY || shape.view == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  const uint32_t largest = shape.coordinates == 3 ? 16 : 40;
  spec.extent = {1 + random.below(largest), 1, 1};
  if (!flat) spec.extent.height = cube ? spec.extent.width : 1 + random.below(largest);
  if (shape.view == VK_IMAGE_VIEW_TYPE_3D) spec.extent.depth = 1 + random.below(8);
  if (array) spec.layers = 1 + random.below(6);
  if (cube) spec.layers = shape.view == VK_IMAGE_VIEW_TYPE_CUBE ? 6 : 12;
  const uint32_t side = std::max(spec.extent.width, spec.extent.height);
  if (side >= 4) spec.levels = 1 + random.below(3);
  Level level{run.image(spec), {}};
  run.fill_random(level.image);
  const uint32_t number = random.below(spec.levels);
  level.image.view =
      run.image_view(level.image, shape.view, format, {VK_IMAGE_ASPECT_COLOR_BIT, number, 1, 0, spec.layers});
  const VkExtent3D extent = level.image.level_extent(number);
  level.size[0] = extent.width;
  level.size[1] = flat ? spec.layers : extent.height;
  level.size[2] = shape.view == VK_IMAGE_VIEW_TYPE_3D ? extent.depth : flat ? 1 : spec.layers;
  return level;
}

/// Coordinates of loads, most of them inside of the level.
std::vector<int32_t> random_places(Random& random, const Level& level, size_t count) {
  std::vector<int32_t> places;
  for (size_t i = 0; i < count; ++i) {
    for (const uint32_t size : level.size) {
      const auto n = static_cast<int32_t>(size);
      places.push_back(random.chance(0.95f) ? random.between(0, n - 1) : random.between(-2, n + 2));
    }
    places.push_back(0);
  }
  return places;
}

std::string coordinates(const std::string& vector, uint32_t count) {
  return count == 1 ? vector + ".x" : vector + "." + std::string("xyz").substr(0, count);
}

std::string size_text(const Level& level) {
  return "const ivec3 size = ivec3(" + std::to_string(level.size[0]) + ", " + std::to_string(level.size[1]) + ", " +
         std::to_string(level.size[2]) + ");\n";
}

std::string image_text(uint32_t binding, const FormatInfo& info, const Shape& shape, const char* name) {
  return "layout(binding = " + std::to_string(binding) + ", " + image_layout(info.format) + ") uniform " +
         glsl_prefix(info) + "image" + shape.name + " " + name + ";\n";
}

/// Formats of one kind of number.
std::vector<VkFormat> formats_like(VkFormat format) {
  std::vector<VkFormat> result;
  for (const VkFormat other : storage_formats(VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
    if (glsl_prefix(format_info(other)) == glsl_prefix(format_info(format))) result.push_back(other);
  return result;
}

const Shape& random_shape(Run& run) {
  const Shape& shape = kShapes[run.random.below(std::size(kShapes))];
  if (shape.view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) run.require(run.gpu.features.imageCubeArray, "imageCubeArray");
  return shape;
}

/// Every texel of one image is made of one of another; all formats in turn.
CTS_RANDOM("image", "random_load_store", 120) {
  Random& random = run.random;
  const std::vector<VkFormat> formats = storage_formats(VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
  const Shape& shape = random_shape(run);
  const VkFormat from_format = formats[run.index % formats.size()];
  const VkFormat to_format = random.pick(formats_like(from_format));
  const FormatInfo &from_info = format_info(from_format), &to_info = format_info(to_format);
  const Level from = random_level(run, shape, from_format), to = random_level(run, shape, to_format);
  const std::string prefix = glsl_prefix(from_info);
  const uint32_t count = to.texels();
  const Buffer places = run.buffer_of(random_places(random, from, count)),
               loaded = run.buffer(VkDeviceSize{16} * count);
  const std::string change =
      random.pick<std::string>(prefix.empty() ? std::vector<std::string>{"v", "v.wzyx", "v * 1.5 - 0.25", "v * v.yxzw"}
                                              : std::vector<std::string>{"v", "v.wzyx", "v * 3 - v.yxzw", "v << 3"});
  const std::string code = image_text(0, from_info, shape, "a") + image_text(1, to_info, shape, "b") +
                           "layout(std430, binding = 2) readonly buffer W { ivec4 w[]; };\n"
                           "layout(std430, binding = 3) writeonly buffer R { " +
                           prefix + "vec4 r[]; };\n" + size_text(to) + "void work(int i) {\n  " + prefix +
                           "vec4 v = imageLoad(a, " + coordinates("w[i]", shape.coordinates) +
                           ");\n  r[i] = v;\n  imageStore(b, " + shape.place + ", " + change +
                           ");\n  if (i % 7 == 0) imageStore(b, " + shape.place + " + " +
                           std::to_string(random.pick({1000, -1000})) + ", v);\n}\n";
  const WorkStage stage = random_work_stage(run);
  run.note("code", name_of(stage) + code);
  const Resources res = run.resources(
      {storage_image(0, from.image), storage_image(1, to.image), storage_buffer(2, places), storage_buffer(3, loaded)});
  run_work_items(run, stage, res, code, count);
  run.out("loaded", loaded, prefix.empty() ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32B32A32_UINT)
      .nan_bits_free = true;
  run.out("stored", to.image);
  for (Output& output : run.outputs) output.nan_bits_free = output.may_be_blank = true;
}

/// Sizes of images, levels and arrays.
CTS_RANDOM("image", "random_size", 20) {
  const Shape& shape = random_shape(run);
  const Level level = random_level(run, shape, VK_FORMAT_R32_UINT);
  const Buffer sizes = run.buffer_of(std::vector<int32_t>(4, 0));
  const std::string code = image_text(0, format_info(VK_FORMAT_R32_UINT), shape, "a") +
                           "layout(std430, binding = 1) writeonly buffer R { int r[]; };\n"
                           "void work(int i) { r[i] = imageSize(a)" +
                           (std::strstr(shape.name, "1D") == shape.name && shape.coordinates == 1 ? "" : "[i]") +
                           "; }\n";
  const WorkStage stage = random_work_stage(run);
  run.note("code", name_of(stage) + code);
  const Resources res = run.resources({storage_image(0, level.image), storage_buffer(1, sizes)});
  // A cube has the size of a face.
  run_work_items(run, stage, res, code, shape.view == VK_IMAGE_VIEW_TYPE_CUBE ? 2 : shape.coordinates);
  run.out("sizes", sizes);
  run.may_be_blank();
}

/// Sums, minima and so on at places that several work items share; results where they do not.
CTS_RANDOM("image", "random_atomics", 60) {
  Random& random = run.random;
  const Shape& shape = random_shape(run);
  const bool is_signed = random.chance(0.5f);
  const VkFormat format = is_signed ? VK_FORMAT_R32_SINT : VK_FORMAT_R32_UINT;
  const Level shared = random_level(run, shape, format), own = random_level(run, shape, format);
  const uint32_t count = own.texels();
  const std::string type = is_signed ? "int" : "uint";
  const Buffer places = run.buffer_of(random_places(random, shared, count)), old = run.buffer(VkDeviceSize{4} * count);
  std::vector<uint32_t> words(count);
  for (uint32_t& word : words) word = random.bits() >> random.below(32);
  const Buffer values = run.buffer_of(words);
  const std::string commutes = random.pick({"Add", "Min", "Max", "And", "Or", "Xor"});
  const std::string any = random.pick({"Add", "Min", "Max", "And", "Or", "Xor", "Exchange", "CompSwap"});
  const std::string code =
      image_text(0, format_info(format), shape, "a") + image_text(1, format_info(format), shape, "b") +
      "layout(std430, binding = 2) readonly buffer W { ivec4 w[]; };\n"
      "layout(std430, binding = 3) writeonly buffer R { " +
      type + " r[]; };\nlayout(std430, binding = 4) readonly buffer V { " + type + " v[]; };\n" + size_text(own) +
      "void work(int i) {\n  imageAtomic" + commutes + "(a, " + coordinates("w[i]", shape.coordinates) +
      ", v[i]);\n  r[i] = imageAtomic" + any + "(b, " + shape.place +
      (any == "CompSwap" ? ", (i & 1) != 0 ? imageLoad(b, " + std::string(shape.place) + ").x : " + type + "(i)" : "") +
      ", v[i]);\n}\n";
  const WorkStage stage = random_work_stage(run);
  run.note("code", name_of(stage) + code);
  const Resources res = run.resources({storage_image(0, shared.image), storage_image(1, own.image),
                                       storage_buffer(2, places), storage_buffer(3, old), storage_buffer(4, values)});
  run_work_items(run, stage, res, code, count);
  run.out("shared", shared.image);
  run.out("own", own.image);
  run.out("old", old);
  run.may_be_blank();
}

/// Samples of multisampled images: stored, then loaded from random places.
CTS_RANDOM("image", "random_multisample", 30) {
  run.require(run.gpu.features.shaderStorageImageMultisample, "shaderStorageImageMultisample");
  Random& random = run.random;
  const std::vector<VkFormat> formats = storage_formats(VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
  const bool array = random.chance(0.4f);
  ImageSpec spec;
  spec.format = formats[run.index % formats.size()];
  spec.extent = {1 + random.below(16), 1 + random.below(16), 1};
  spec.layers = array ? 1 + random.below(4) : 1;
  spec.samples = VK_SAMPLE_COUNT_4_BIT;
  spec.view = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const FormatInfo& info = format_info(spec.format);
  const Level level{run.image(spec), {spec.extent.width, spec.extent.height, spec.layers}};
  const std::string prefix = glsl_prefix(info);
  const Shape shape{spec.view, array ? "2DMSArray" : "2DMS", array ? 3u : 2u, kShapes[array ? 3 : 2].place};
  const uint32_t count = level.texels();
  const Buffer places = run.buffer_of(random_places(random, level, count));
  const Buffer values = run.buffer_of(random_texels(
      random, prefix.empty() ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32B32A32_UINT, size_t{64} * count));
  const Buffer loaded = run.buffer(VkDeviceSize{64} * count);
  const std::string head = image_text(0, info, shape, "a") +
                           "layout(std430, binding = 1) readonly buffer W { ivec4 w[]; };\n"
                           "layout(std430, binding = 2) readonly buffer V { " +
                           prefix + "vec4 v[]; };\nlayout(std430, binding = 3) writeonly buffer R { " + prefix +
                           "vec4 r[]; };\n" + size_text(level) +
                           "void work(int i) {\n  for (int s = 0; s < 4; ++s)\n    ";
  const std::string store = head + "imageStore(a, " + shape.place + ", s, v[i * 4 + s]);\n}\n";
  const std::string load =
      head + "r[i * 4 + s] = imageLoad(a, " + coordinates("w[i]", shape.coordinates) + ", s ^ 1);\n}\n";
  run.note("code", store + load);
  const Resources res = run.resources(
      {storage_image(0, level.image), storage_buffer(1, places), storage_buffer(2, values), storage_buffer(3, loaded)});
  run_work_items(run, random_work_stage(run), res, store, count);
  run_work_items(run, random_work_stage(run), res, load, count);
  run.out("loaded", loaded, prefix.empty() ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32B32A32_UINT)
      .nan_bits_free = true;
  run.may_be_blank();
}

}  // namespace
}  // namespace vitrine::cts
