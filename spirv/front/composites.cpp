// Composite and matrix instructions (SPIR-V 3.42.12, .13).
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using Leaves = std::vector<ir::ValueId>;
using Columns = std::vector<Expr>;

Columns columns_of(Translator& t, std::uint32_t id) { return leaf_numbers(t, value_of(t, id)); }

Columns transposed(const Columns& columns) {
  const std::uint32_t rows = columns.at(0).size();
  Columns result;
  for (std::uint8_t r = 0; r < rows; r++) {
    std::vector<Expr> parts;
    for (const Expr& column : columns) parts.push_back(column.at(r));
    result.push_back(vector_of(parts));
  }
  return result;
}

/// sum of a[j] * v[j] from the last column to the first (lavapipe-shader-math.md 5.1).
Expr columns_times_vector(const Columns& a, const Expr& v) {
  auto j = static_cast<std::uint8_t>(a.size() - 1);
  Expr sum = a[j] * v.at(j);
  while (j-- > 0) sum = multiply_add(a[j], v.at(j), sum);
  return sum;
}

/// a * b where `a_rows`, if known, are the rows of a: then every element is a dot product (5.1), but only of 32-bit
/// numbers.
Columns multiply(const Inst& inst, const Columns& a, const Columns* a_rows, const Columns& b) {
  Columns result;
  for (const Expr& column : b) {
    if (a.empty() || column.size() != a.size()) fail(inst, "shapes of matrices do not fit");
    if (a_rows == nullptr || column.width != 32) {
      result.push_back(columns_times_vector(a, column));
      continue;
    }
    std::vector<Expr> parts;
    for (const Expr& row : *a_rows) parts.push_back(dot(row, column));
    result.push_back(vector_of(parts));
  }
  return result;
}

/// The matrix that `id` is the OpTranspose of, if it is one.
std::optional<Columns> transpose_source(Translator& t, std::uint32_t id) {
  if (t.module.constant(id) != nullptr) return {};
  const Inst& def = t.module.def(id);
  if (def.op != spv::Op::OpTranspose) return {};
  return columns_of(t, def.operand(0));
}

const Columns* pointer_to(const std::optional<Columns>& columns) { return columns ? &*columns : nullptr; }

}  // namespace

Expr dot(const Expr& a, const Expr& b) {
  Translator& t = *a.t;
  const std::uint32_t n = std::max(a.size(), b.size());
  if (n == 1) return a * b;
  if (a.width != 64) {
    Expr sum{&t, emit(t, for_size(ir::Op::kFDot2, n), 1, false, {a.src(), b.src()}, a.width)};
    sum.width = a.width;
    return sum;
  }
  Expr sum = a.at(0) * b.at(0);
  for (std::uint8_t i = 1; i < n; i++) sum = apply(ir::Op::kFAddInSum, {sum, a.at(i) * b.at(i)});
  return sum;
}

void dot_product(Translator& t, const Inst& inst, ir::Op) {
  set_number(t, inst, dot(number_of(t, inst.operand(0)), number_of(t, inst.operand(1))));
}

void matrix_times(Translator& t, const Inst& inst, ir::Op) {
  const std::uint32_t left = inst.operand(0), right = inst.operand(1);
  const Columns a = columns_of(t, left), b = columns_of(t, right);
  if (inst.op == spv::Op::OpVectorTimesMatrix) {
    // v * M = transpose(M) * v; where M is itself a transpose, its source's columns are at hand.
    const auto source = transpose_source(t, right);
    return set_numbers(t, inst, source ? multiply(inst, *source, nullptr, a) : multiply(inst, transposed(b), &b, a));
  }
  const auto a_rows = transpose_source(t, left);
  const auto b_rows = inst.op == spv::Op::OpMatrixTimesMatrix ? transpose_source(t, right) : std::nullopt;
  if (a_rows && b_rows)  // transpose(A) * transpose(B) = transpose(B * A)
    return set_numbers(t, inst, transposed(multiply(inst, *b_rows, nullptr, *a_rows)));
  set_numbers(t, inst, multiply(inst, a, pointer_to(a_rows), b));
}

void times_scalar(Translator& t, const Inst& inst, ir::Op op) {
  const Expr scalar = number_of(t, inst.operand(1));
  Columns result;
  for (const Expr& column : columns_of(t, inst.operand(0))) result.push_back(apply(op, {column, scalar}));
  set_numbers(t, inst, result);
}

void outer_product(Translator& t, const Inst& inst, ir::Op op) {
  const Expr a = number_of(t, inst.operand(0)), b = number_of(t, inst.operand(1));
  Columns result;
  for (std::uint8_t i = 0; i < b.size(); i++) result.push_back(apply(op, {a, b.at(i)}));
  set_numbers(t, inst, result);
}

void transpose(Translator& t, const Inst& inst, ir::Op) {
  set_numbers(t, inst, transposed(columns_of(t, inst.operand(0))));
}

void undef(Translator& t, const Inst& inst, ir::Op) {
  const Type& type = t.module.type(inst.result_type);
  if (is_too_large(type)) fail(inst, "value is too large");
  if (type.leaves == 0) return;  // an image or a sampler: nothing can be done with it
  const std::vector<std::uint32_t> zeros(type.scalars, 0);
  set_value(t, inst, constant_value(t, inst.result_type, zeros, true).leaves);
}

void copy_object(Translator& t, const Inst& inst, ir::Op) {
  const std::uint32_t id = inst.operand(0);
  if (const auto image = t.images.find(id); image != t.images.end()) {
    t.images[inst.result] = image->second;
  } else if (t.module.type(inst.result_type).kind == Type::Kind::kPointer) {
    t.pointers[inst.result] = pointer_of(t, id);
  } else {
    set_value(t, inst, value_of(t, id).leaves);
  }
}

/// The bits of scalars as 32-bit words, and back.
void bitcast(Translator& t, const Inst& inst, ir::Op) {
  const Expr value = number_of(t, inst.operand(0));
  const auto width = static_cast<std::uint8_t>(number_type(t, inst.result_type).width);
  const std::uint32_t count = leaf_info(t, inst.result_type).components;
  if (width * count != value.width * value.size()) fail(inst, "size changes");
  if (width == value.width) return set_number(t, inst, value);
  std::vector<Expr> words;
  for (std::uint32_t i = 0; i < value.size(); i++) {
    const Expr part = value[i];
    if (part.width == 64) {
      words.push_back({&t, part.id});
      words.push_back({&t, part.high});
      continue;
    }
    const std::uint32_t shift = i * part.width % 32;
    const Expr word = shift == 0 ? Expr{&t, part.id} : Expr{&t, part.id} << shift;
    if (shift == 0)
      words.push_back(word);
    else
      words.back() = words.back() | word;
  }
  std::vector<Expr> parts;
  for (std::uint32_t i = 0; i < count; i++) {
    const std::uint32_t first = i * width / 32, shift = i * width % 32;
    Expr part = words.at(first);
    part.width = width;
    if (width == 64) part.high = words.at(first + 1).id;
    if (width < 32) part = convert_unsigned(shift == 0 ? words[first] : words[first] >> shift, width);
    parts.push_back(part);
  }
  set_number(t, inst, vector_of(parts));
}

void composite_construct(Translator& t, const Inst& inst, ir::Op) {
  const Type& type = t.module.type(inst.result_type);
  if (type.kind != Type::Kind::kVector) {
    Leaves leaves;
    for (std::uint32_t i = 0; inst.has(i); i++) {
      const Leaves& part = value_of(t, inst.operand(i)).leaves;
      leaves.insert(leaves.end(), part.begin(), part.end());
    }
    return set_value(t, inst, std::move(leaves));
  }
  std::vector<Expr> parts;
  const std::uint32_t width = number_type(t, inst.result_type).width;
  for (std::uint32_t i = 0; inst.has(i); i++) {
    const Expr part = number_of(t, inst.operand(i));
    if (part.width != width) fail(inst, "parts of another width");
    for (std::uint8_t c = 0; c < part.size(); c++) parts.push_back(part.at(c));
  }
  if (parts.size() != type.count) fail(inst, "parts do not fill the vector");
  set_number(t, inst, vector_of(parts));
}

void composite_replicate(Translator& t, const Inst& inst, ir::Op) {
  const Type& type = t.module.type(inst.result_type);
  const std::uint32_t count = constituents(type);
  if (is_too_large(type)) fail(inst, "composite is too large");
  if (type.kind == Type::Kind::kVector) {
    const Expr part = number_of(t, inst.operand(0));
    if (part.width != number_type(t, inst.result_type).width || part.size() != 1)
      fail(inst, "the part is no component of the vector");
    return set_number(t, inst, vector_of(std::vector<Expr>(count, part)));
  }
  const Leaves part = value_of(t, inst.operand(0)).leaves;
  if (std::uint64_t{count} * part.size() != type.leaves) fail(inst, "parts do not fill the composite");
  Leaves leaves;
  for (std::uint32_t i = 0; i < count; i++) leaves.insert(leaves.end(), part.begin(), part.end());
  set_value(t, inst, std::move(leaves));
}

void composite_extract(Translator& t, const Inst& inst, ir::Op) {
  const Value& from = value_of(t, inst.operand(0));
  const Part part = find_part(t, inst, from.type, 1);
  const std::uint32_t count = t.module.type(part.type).leaves;
  if (part.first + count > from.leaves.size()) fail(inst, "index out of range");
  Leaves leaves(from.leaves.begin() + part.first, from.leaves.begin() + part.first + count);
  if (part.component)
    for (ir::ValueId& leaf : leaves) leaf = extract(t, leaf, *part.component);
  set_value(t, inst, std::move(leaves));
}

void composite_insert(Translator& t, const Inst& inst, ir::Op) {
  const Value object = value_of(t, inst.operand(0));
  Value whole_value = value_of(t, inst.operand(1));
  const Part part = find_part(t, inst, whole_value.type, 2);
  if (part.first + object.leaves.size() > whole_value.leaves.size() ||
      object.leaves.size() != t.module.type(part.type).leaves)
    fail(inst, "object does not fit");
  for (std::size_t i = 0; i < object.leaves.size(); i++) {
    ir::ValueId& leaf = whole_value.leaves[part.first + i];
    leaf = part.component ? insert(t, leaf, object.leaves[i], *part.component) : object.leaves[i];
  }
  set_value(t, inst, std::move(whole_value.leaves));
}

void vector_shuffle(Translator& t, const Inst& inst, ir::Op) {
  const Expr a = number_of(t, inst.operand(0)), b = number_of(t, inst.operand(1));
  const std::uint32_t split = a.size(), total = split + b.size();
  const bool boolean = is_boolean(t, a.id);
  std::vector<Expr> parts;
  for (std::uint32_t i = 2; inst.has(i); i++) {
    const std::uint32_t c = inst.operand(i);
    if (c != UINT32_MAX && c >= total) fail(inst, "component out of range");
    if (c == UINT32_MAX) {
      Expr unknown{&t, undefined(t, 1, boolean)};
      unknown.width = a.width;
      if (a.high != ir::kNoValue) unknown.high = unknown.id;
      parts.push_back(unknown);
    } else {
      parts.push_back(c < split ? a.at(static_cast<std::uint8_t>(c)) : b.at(static_cast<std::uint8_t>(c - split)));
    }
  }
  if (parts.size() != leaf_info(t, inst.result_type).components) fail(inst, "components do not fill the vector");
  set_number(t, inst, vector_of(parts));
}

void vector_extract_dynamic(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId index = index_word(t, inst.operand(1));
  Leaves leaves = value_of(t, inst.operand(0)).leaves;
  for (ir::ValueId& leaf : leaves) leaf = extract_dynamic(t, leaf, index);
  set_value(t, inst, std::move(leaves));
}

void vector_insert_dynamic(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId index = index_word(t, inst.operand(2));
  const Value object = value_of(t, inst.operand(1));
  Leaves leaves = value_of(t, inst.operand(0)).leaves;
  if (object.leaves.size() != leaves.size()) fail(inst, "object does not fit");
  for (std::size_t i = 0; i < leaves.size(); i++) leaves[i] = insert_dynamic(t, leaves[i], object.leaves[i], index);
  set_value(t, inst, std::move(leaves));
}

}  // namespace vitrine::spirv::front
