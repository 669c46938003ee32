// See value.h. Layouts of memory: Vulkan 1.3.239, Offset and Stride Assignment.
#include "glass/debug/value.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "base/numeric.h"

namespace vitrine::glass::debug {
namespace {

using Kind = spirv::SourceType::Kind;
using Memory = spirv::SourceVariable::Memory;

/// Elements of one array, and of all arrays of one text or tree.
constexpr std::uint32_t kMostElements = 64;
constexpr std::size_t kMostRows = 2000;

struct Bytes {
  const std::byte* data = nullptr;
  std::uint64_t size = 0;
};

/// The descriptor of a buffer or image; null: nothing is bound there.
const spirv::Descriptor* descriptor_of(const Viewer& viewer, const Place& place) {
  const Run& run = *viewer.run;
  if (!viewer.memory || run.resources == nullptr) return nullptr;
  const std::uint32_t set = place.variable->set, slot = place.variable->slot + place.descriptor;
  if (set > spirv::kMaxSets || run.resources->set[set] == nullptr || slot >= run.resources->set_size[set])
    return nullptr;
  return &run.resources->set[set][slot];
}

/// The image that a place is; nothing: it is none, or none is bound there.
std::optional<ImageShape> shape_at(const Viewer& viewer, const Place& place) {
  if (place.variable->memory != Memory::kOpaque || place.texel) return std::nullopt;
  const spirv::Descriptor* const image = descriptor_of(viewer, place);
  return image == nullptr ? std::nullopt : shape_of(*image);
}

/// The memory that a variable lies in.
Bytes memory_of(const Viewer& viewer, const Place& place) {
  const Run& run = *viewer.run;
  if (!viewer.memory || run.resources == nullptr) return {};
  switch (place.variable->memory) {
    case Memory::kPush:
      return {run.resources->push_constants,
              run.resources->push_constants == nullptr ? 0u : spirv::kMaxPushConstantBytes};
    case Memory::kShared:
      return {run.shared, run.shared_size};
    case Memory::kBuffer: {
      const spirv::Descriptor* const buffer = descriptor_of(viewer, place);
      if (buffer == nullptr || buffer->data == nullptr) return {};
      return {buffer->data, buffer->size};
    }
    default:
      return {};
  }
}

const spirv::SourceType& type_at(const spirv::SourceVariables& tables, const Place& place) {
  return tables.types[place.type];
}

char letter_of(Kind kind) {
  switch (kind) {
    case Kind::kBool:
      return 'B';
    case Kind::kInt:
      return 'I';
    case Kind::kUint:
      return 'U';
    default:
      return 'F';
  }
}

bool is_number(Kind kind) {
  return kind == Kind::kBool || kind == Kind::kInt || kind == Kind::kUint || kind == Kind::kFloat;
}

/// One number at a place in cells.
Scalar read_cells(const Viewer& viewer, const Place& place, const spirv::SourceType& type) {
  Scalar scalar{letter_of(type.kind), type.kind == Kind::kBool ? 32 : type.width, 0};
  for (std::uint32_t i = 0; i < type.cells; ++i) {
    if (!viewer.run->known(place.cell + i, viewer.lane)) return {};
    scalar.bits |= std::uint64_t{viewer.run->word(place.cell + i, viewer.lane)} << 32 * i;
  }
  return scalar;
}

Scalar read_memory(const Viewer& viewer, const Place& place, const spirv::SourceType& type) {
  const Bytes bytes = memory_of(viewer, place);
  const std::uint64_t size = stored_bytes(viewer, place);
  if (bytes.data == nullptr || place.offset > bytes.size || bytes.size - place.offset < size) return {};
  Scalar scalar{letter_of(type.kind), type.kind == Kind::kBool ? 32 : type.width, 0};
  std::memcpy(&scalar.bits, bytes.data + place.offset, size);
  return scalar;
}

std::uint64_t step_of(const spirv::SourceVariables& tables, const Place& place) {
  const spirv::SourceType& type = type_at(tables, place);
  const spirv::SourceType& element = tables.types[type.element];
  if (place.variable->word_layout) return 4ull * element.cells;
  switch (type.kind) {
    case Kind::kMatrix:
      return place.row_major ? tables.types[element.element].width / 8 : place.matrix_stride;
    case Kind::kVector:
      return place.component_stride != 0 ? place.component_stride : element.width / 8;
    default:
      return type.array_stride;
  }
}

std::string float_text(double value, std::uint32_t width) {
  char text[64];
  const std::to_chars_result end = width == 64 ? std::to_chars(text, text + sizeof(text), value)
                                               : std::to_chars(text, text + sizeof(text), static_cast<float>(value));
  std::string result(text, end.ptr);
  if (result.find_first_not_of("-0123456789") == std::string::npos) result += ".0";
  return result;
}

/// Text of places, cut where it gets long.
class Writer {
 public:
  explicit Writer(const Viewer& viewer) : viewer_(viewer) {}

  std::string text(const Place& place) {
    const spirv::SourceType& type = type_at(viewer_.tables(), place);
    if (place.texel) return numbers_text(numbers_of(viewer_, place));
    if (place.variable->memory == Memory::kOpaque && !place.descriptors) return image(place);
    if (place.descriptors || type.kind == Kind::kArray || type.kind == Kind::kMatrix) return elements(place);
    if (type.kind == Kind::kStruct) return members(place, type);
    return numbers_text(numbers_of(viewer_, place));
  }

  static std::string numbers_text(const std::vector<Scalar>& numbers) {
    if (numbers.empty()) return "<no value>";
    if (numbers.size() == 1) return to_text(numbers[0]);
    std::string text = "(";
    for (const Scalar& number : numbers) text.append(text.size() == 1 ? "" : ", ").append(to_text(number));
    return text += ")";
  }

 private:
  /// "R32_UINT, 4 x 4", with the texels of small ones, the first coordinate inside.
  std::string image(const Place& place) {
    const std::optional<ImageShape> shape = shape_at(viewer_, place);
    if (!shape) return "<image or sampler>";
    std::string text(shape->format->name);
    std::uint64_t texels = 1;
    for (std::uint32_t i = 0; i < shape->dimensions; ++i) {
      text.append(i == 0 ? ", " : " x ").append(std::to_string(shape->size[i]));
      texels *= shape->size[i];
    }
    if (texels > kMostElements) return text;
    TexelCoordinates at{};
    return text + " " + texels_text(place, *shape, shape->dimensions, at);
  }

  std::string texels_text(Place place, const ImageShape& shape, std::uint32_t dimension, TexelCoordinates& at) {
    if (dimension == 0) {
      place.texel = at;
      return text(place);
    }
    std::string all = "{";
    for (std::uint32_t i = 0; i < shape.size[dimension - 1]; ++i) {
      at[dimension - 1] = i;
      all.append(i == 0 ? "" : ", ").append(texels_text(place, shape, dimension - 1, at));
    }
    return all += "}";
  }

  std::string elements(const Place& place) {
    const std::uint32_t count = count_of(viewer_, place);
    std::string text = "{";
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i != 0) text += ", ";
      if (i == kMostElements || ++rows_ > kMostRows) return text += "...}";
      text += this->text(element_of(viewer_.tables(), place, i));
    }
    return text += "}";
  }

  std::string members(const Place& place, const spirv::SourceType& type) {
    std::string text = "{";
    for (std::uint32_t i = 0; i < type.members.size(); ++i) {
      if (i != 0) text += ", ";
      if (++rows_ > kMostRows) return text += "...}";
      text.append(type.members[i].name).append(" = ").append(this->text(member_of(viewer_.tables(), place, i)));
    }
    return text += "}";
  }

  const Viewer& viewer_;
  std::size_t rows_ = 0;
};

/// Texels of an image, whose last coordinates are known: rows and layers have names with a space, which are no part of
/// an expression.
void add_texels(const Viewer& viewer, Place place, const ImageShape& shape, std::uint32_t dimension,
                TexelCoordinates& at, Tree& tree, std::size_t& rows) {
  const std::uint32_t count = std::min(shape.size[dimension - 1], kMostElements);
  for (std::uint32_t i = 0; i < count && ++rows <= kMostRows; ++i) {
    at[dimension - 1] = i;
    if (dimension > 1) {
      Tree& part = tree.children.emplace_back();
      part.name = (dimension == 2 ? "row " : "layer ") + std::to_string(i);
      add_texels(viewer, place, shape, dimension - 1, at, part, rows);
      continue;
    }
    std::string name = "[";
    for (std::uint32_t c = 0; c < shape.dimensions; ++c) name.append(c == 0 ? "" : ", ").append(std::to_string(at[c]));
    place.texel = at;
    tree.children.push_back({name + "]", "texel", Writer(viewer).text(place), {}});
  }
}

Tree make_tree(const Viewer& viewer, std::string name, const Place& place, std::size_t& rows) {
  const spirv::SourceType& type = type_at(viewer.tables(), place);
  Tree tree{std::move(name), type.name, Writer(viewer).text(place), {}};
  if (place.texel) tree.type = "texel";
  if (++rows > kMostRows || place.texel) return tree;
  if (const auto shape = place.descriptors ? std::nullopt : shape_at(viewer, place)) {
    TexelCoordinates at{};
    add_texels(viewer, place, *shape, shape->dimensions, at, tree, rows);
    return tree;
  }
  if (place.variable->memory == Memory::kOpaque && !place.descriptors) return tree;
  if (type.kind == Kind::kStruct && !place.descriptors) {
    for (std::uint32_t i = 0; i < type.members.size(); ++i)
      tree.children.push_back(make_tree(viewer, type.members[i].name, member_of(viewer.tables(), place, i), rows));
  } else if (!is_number(type.kind) || place.descriptors) {
    const std::uint32_t count = std::min(count_of(viewer, place), kMostElements);
    for (std::uint32_t i = 0; i < count; ++i)
      tree.children.push_back(
          make_tree(viewer, '[' + std::to_string(i) + "]", element_of(viewer.tables(), place, i), rows));
  }
  return tree;
}

}  // namespace

Scalar make_bool(bool value) { return {'B', 32, value ? 1u : 0u}; }
Scalar make_int(std::int64_t value) { return {'I', 32, static_cast<std::uint32_t>(value)}; }
Scalar make_uint(std::uint64_t value, std::uint32_t width) {
  return {'U', width, width >= 64 ? value : value & ((std::uint64_t{1} << width) - 1)};
}

Scalar make_float(double value, std::uint32_t width) {
  Scalar scalar{'F', width, 0};
  const auto narrow = static_cast<float>(value);
  if (width == 64)
    std::memcpy(&scalar.bits, &value, 8);
  else if (width == 16)
    scalar.bits = base::float_to_half_nearest(narrow);
  else
    std::memcpy(&scalar.bits, &narrow, 4);
  return scalar;
}

std::int64_t to_int(const Scalar& scalar) {
  if (scalar.type == 'F') return static_cast<std::int64_t>(std::clamp(to_double(scalar), -9e18, 9e18));
  if (scalar.type == 'I' && scalar.width < 64)
    return static_cast<std::int64_t>(scalar.bits << (64 - scalar.width)) >> (64 - scalar.width);
  return static_cast<std::int64_t>(scalar.bits);
}

double to_double(const Scalar& scalar) {
  if (scalar.type != 'F')
    return scalar.type == 'U' ? static_cast<double>(scalar.bits) : static_cast<double>(to_int(scalar));
  if (scalar.width == 16) return static_cast<double>(base::half_to_float(static_cast<std::uint16_t>(scalar.bits)));
  if (scalar.width == 32) {
    float value = 0;
    std::memcpy(&value, &scalar.bits, 4);
    return static_cast<double>(value);
  }
  double value = 0;
  std::memcpy(&value, &scalar.bits, 8);
  return value;
}

bool to_bool(const Scalar& scalar) {
  return scalar.type == 'F' ? to_double(scalar) != 0 : scalar.type != '?' && scalar.bits != 0;
}

std::string to_text(const Scalar& scalar) {
  switch (scalar.type) {
    case 'B':
      return scalar.bits != 0 ? "true" : "false";
    case 'I':
      return std::to_string(to_int(scalar));
    case 'U':
      return std::to_string(scalar.bits);
    case 'F':
      return float_text(to_double(scalar), scalar.width);
    default:
      return "<no value>";
  }
}

Place place_of(const spirv::SourceVariable& variable) {
  Place place;
  place.variable = &variable;
  place.type = variable.type;
  place.cell = variable.first_cell;
  place.offset = variable.offset;
  place.descriptors = variable.descriptors != 0;
  return place;
}

Place element_of(const spirv::SourceVariables& tables, const Place& place, std::uint32_t index) {
  Place part = place;
  if (place.descriptors) {
    part.descriptors = false;
    part.descriptor = index;
    return part;
  }
  const spirv::SourceType& type = type_at(tables, place);
  if (type.kind == Kind::kMatrix && place.row_major) part.component_stride = place.matrix_stride;
  part.component = type.kind == Kind::kVector ? index : 0;
  part.components = type.kind == Kind::kVector ? type.count : 1;
  part.type = type.element;
  part.cell += index * tables.types[type.element].cells;
  part.offset += index * step_of(tables, place);
  return part;
}

Place member_of(const spirv::SourceVariables& tables, const Place& place, std::uint32_t member) {
  const spirv::SourceType& type = type_at(tables, place);
  Place part = place;
  part.type = type.members[member].type;
  std::uint32_t cells = 0;
  for (std::uint32_t i = 0; i < member; ++i) cells += tables.types[type.members[i].type].cells;
  part.cell += cells;
  part.offset += place.variable->word_layout ? 4ull * cells : type.members[member].offset;
  part.matrix_stride = type.members[member].matrix_stride;
  part.row_major = type.members[member].row_major;
  return part;
}

std::uint32_t count_of(const Viewer& viewer, const Place& place) {
  if (place.descriptors) return place.variable->descriptors;
  const spirv::SourceType& type = type_at(viewer.tables(), place);
  if (type.kind != Kind::kArray || type.count != 0) return type.count;
  const std::uint64_t step = step_of(viewer.tables(), place), size = memory_of(viewer, place).size;
  if (step == 0 || place.offset >= size) return 0;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>((size - place.offset) / step, UINT32_MAX));
}

std::uint32_t stored_bytes(const Viewer& viewer, const Place& place) {
  const spirv::SourceType& type = type_at(viewer.tables(), place);
  if (place.variable->word_layout) return 4 * type.cells;
  return type.kind == Kind::kBool ? 4 : type.width / 8;
}

namespace {

/// Most bytes that memory_of_place() tells.
constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 20;

/// Appends what the place holds; false: it is too much.
bool append_memory(const Viewer& viewer, const Place& place, std::vector<MemoryRange>& ranges, std::uint64_t& left) {
  const spirv::SourceType& type = type_at(viewer.tables(), place);
  if (is_number(type.kind) && !place.descriptors) {
    const std::uint32_t size = stored_bytes(viewer, place);
    const Bytes bytes = memory_of(viewer, place);
    if (bytes.data == nullptr || place.offset > bytes.size || bytes.size - place.offset < size) return true;
    if (left < size) return false;
    left -= size;
    auto* const at = const_cast<std::byte*>(bytes.data) + place.offset;
    if (!ranges.empty() && ranges.back().at + ranges.back().bytes == at)
      ranges.back().bytes += size;
    else
      ranges.push_back({at, size});
    return true;
  }
  if (type.kind == Kind::kStruct && !place.descriptors) {
    for (std::uint32_t i = 0; i < type.members.size(); ++i)
      if (!append_memory(viewer, member_of(viewer.tables(), place, i), ranges, left)) return false;
    return true;
  }
  if (type.kind == Kind::kOther) return true;
  const std::uint32_t count = count_of(viewer, place);
  if (count > left) return false;
  for (std::uint32_t i = 0; i < count; ++i)
    if (!append_memory(viewer, element_of(viewer.tables(), place, i), ranges, left)) return false;
  return true;
}

}  // namespace

std::optional<StoredTexelAt> texel_at(const Viewer& viewer, const Place& place) {
  const spirv::Descriptor* const image = place.texel ? descriptor_of(viewer, place) : nullptr;
  return image == nullptr ? std::nullopt : find_texel(*image, *place.texel);
}

std::vector<MemoryRange> memory_of_place(const Viewer& viewer, const Place& place) {
  if (place.texel) {
    const auto texel = texel_at(viewer, place);
    if (!texel) return {};
    return {{texel->at, texel->bytes}};
  }
  if (place.variable->memory == Memory::kCells || place.variable->memory == Memory::kOpaque) return {};
  std::vector<MemoryRange> ranges;
  std::uint64_t left = kMostMemory;
  if (!append_memory(viewer, place, ranges, left)) ranges.clear();
  return ranges;
}

std::vector<Scalar> numbers_of(const Viewer& viewer, const Place& place) {
  if (place.texel) {
    std::vector<Scalar> numbers;
    const auto texel = texel_at(viewer, place);
    if (!texel) return numbers;
    const texel::Kind kind = texel->format->kind;
    const char letter = kind == texel::Kind::kFloat ? 'F' : kind == texel::Kind::kSint ? 'I' : 'U';
    for (const std::uint32_t bits : decode(*texel)) numbers.push_back({letter, 32, bits});
    return numbers;
  }
  const spirv::SourceType& type = type_at(viewer.tables(), place);
  if (place.descriptors || place.variable->memory == Memory::kOpaque) return {};
  if (type.kind == Kind::kVector) {
    std::vector<Scalar> numbers;
    for (std::uint32_t i = 0; i < type.count; ++i) {
      const std::vector<Scalar> one = numbers_of(viewer, element_of(viewer.tables(), place, i));
      numbers.insert(numbers.end(), one.begin(), one.end());
    }
    return numbers;
  }
  if (!is_number(type.kind)) return {};
  return {place.variable->memory == Memory::kCells ? read_cells(viewer, place, type)
                                                   : read_memory(viewer, place, type)};
}

std::string to_text(const Viewer& viewer, const Value& value) {
  if (!value.list.empty()) {
    std::string text = "{";
    for (std::size_t i = 0; i < value.list.size(); ++i) {
      if (i != 0) text += ", ";
      if (!value.names.empty()) text.append(value.names[i]).append(" = ");
      text += to_text(viewer, value.list[i]);
    }
    return text += "}";
  }
  return value.place ? Writer(viewer).text(*value.place) : Writer::numbers_text(value.scalars);
}

std::string type_of(const Viewer& viewer, const Value& value) {
  if (value.place && value.place->texel) return "texel";
  if (value.place) return type_at(viewer.tables(), *value.place).name;
  if (value.scalars.empty()) return {};
  const char type = value.scalars[0].type;
  const std::size_t count = value.scalars.size();
  if (count == 1) return type == 'B' ? "bool" : type == 'I' ? "int" : type == 'U' ? "uint" : "float";
  return (type == 'B' ? "bvec" : type == 'I' ? "ivec" : type == 'U' ? "uvec" : "vec") + std::to_string(count);
}

Tree tree_of(const Viewer& viewer, std::string name, const Value& value) {
  std::size_t rows = 0;
  if (value.place) return make_tree(viewer, std::move(name), *value.place, rows);
  return {std::move(name), type_of(viewer, value), to_text(viewer, value), {}};
}

}  // namespace vitrine::glass::debug
