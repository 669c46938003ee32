// Composite and matrix instructions (SPIR-V 3.42.12, .13).
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using Columns = std::vector<ir::ValueId>;

Columns transposed(Translator& t, const Columns& columns) {
  const std::uint32_t rows = components(t, columns.at(0));
  Columns result;
  for (std::uint8_t r = 0; r < rows; r++) {
    std::vector<ir::Src> parts;
    for (ir::ValueId column : columns) parts.push_back(splat(column, r));
    result.push_back(vec(t, std::move(parts), false));
  }
  return result;
}

/// sum of a[j] * v[j] from the last column to the first (lavapipe-shader-math.md 5.1).
ir::ValueId columns_times_vector(Translator& t, const Columns& a, ir::ValueId v) {
  const std::uint32_t rows = components(t, a.at(0));
  auto j = static_cast<std::uint8_t>(a.size() - 1);
  ir::ValueId sum = emit(t, ir::Op::kFMul, rows, false, {whole(a[j]), splat(v, j)});
  while (j-- > 0) sum = emit(t, ir::Op::kFMulAdd, rows, false, {whole(a[j]), splat(v, j), whole(sum)});
  return sum;
}

/// a * b where `a_rows`, if known, are the rows of a: then every element is a dot product (5.1).
Columns multiply(Translator& t, const Columns& a, const Columns* a_rows, const Columns& b) {
  Columns result;
  for (ir::ValueId column : b) {
    if (a_rows == nullptr) {
      result.push_back(columns_times_vector(t, a, column));
      continue;
    }
    std::vector<ir::Src> parts;
    for (ir::ValueId row : *a_rows) parts.push_back(whole(dot(t, row, column)));
    result.push_back(vec(t, std::move(parts), false));
  }
  return result;
}

/// The matrix that `id` is the OpTranspose of, or null.
const Columns* transpose_source(Translator& t, std::uint32_t id) {
  if (t.module.constant(id) != nullptr) return nullptr;
  const Inst& def = t.module.def(id);
  return def.op == spv::Op::OpTranspose ? &value_of(t, def.operand(0)).leaves : nullptr;
}

}  // namespace

ir::ValueId dot(Translator& t, ir::ValueId a, ir::ValueId b) {
  const std::uint32_t n = components(t, a);
  const ir::ValueId products = emit(t, ir::Op::kFMul, n, false, {whole(a), whole(b)});
  if (n == 1) return products;
  // Sums of three and four are opaque to the rewrites (5.1), those of two only in the first round, which rewrite()
  // ends.
  const bool saved = std::exchange(t.opaque, true);
  ir::ValueId sum = emit(t, ir::Op::kFAdd, 1, false, {splat(products, 0), splat(products, 1)});
  for (std::uint8_t i = 2; i < n; i++) sum = emit(t, ir::Op::kFAdd, 1, false, {whole(sum), splat(products, i)});
  t.opaque = saved;
  return sum;
}

void dot_product(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, dot(t, scalar_or_vector(t, inst.operand(0)), scalar_or_vector(t, inst.operand(1))));
}

void matrix_times(Translator& t, const Inst& inst, ir::Op) {
  const std::uint32_t left = inst.operand(0), right = inst.operand(1);
  const Columns &a = value_of(t, left).leaves, &b = value_of(t, right).leaves;
  if (inst.op == spv::Op::OpVectorTimesMatrix) {
    // v * M = transpose(M) * v; where M is itself a transpose, its source's columns are at hand.
    const Columns* source = transpose_source(t, right);
    return set_value(t, inst, source ? multiply(t, *source, nullptr, a) : multiply(t, b, &b, a));
  }
  const Columns* a_rows = transpose_source(t, left);
  const Columns* b_rows = inst.op == spv::Op::OpMatrixTimesMatrix ? transpose_source(t, right) : nullptr;
  if (a_rows != nullptr && b_rows != nullptr)  // transpose(A) * transpose(B) = transpose(B * A)
    return set_value(t, inst, transposed(t, multiply(t, *b_rows, nullptr, *a_rows)));
  set_value(t, inst, multiply(t, a, a_rows, b));
}

void times_scalar(Translator& t, const Inst& inst, ir::Op op) {
  const ir::ValueId scalar = number(t, inst.operand(1));
  Columns result;
  for (ir::ValueId column : value_of(t, inst.operand(0)).leaves)
    result.push_back(emit(t, op, components(t, column), false, {whole(column), splat(scalar)}));
  set_value(t, inst, std::move(result));
}

void outer_product(Translator& t, const Inst& inst, ir::Op op) {
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  Columns result;
  for (std::uint8_t i = 0; i < components(t, b); i++)
    result.push_back(emit(t, op, components(t, a), false, {whole(a), splat(b, i)}));
  set_value(t, inst, std::move(result));
}

void transpose(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, transposed(t, value_of(t, inst.operand(0)).leaves));
}

void undef(Translator& t, const Inst& inst, ir::Op) {
  const Type& type = t.module.type(inst.result_type);
  if (type.scalars > kMaxScalars) fail(inst, "value is too large");
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
    if (t.module.type(inst.result_type).leaves == 1) leaf_info(t, inst.result_type);
    set_value(t, inst, value_of(t, id).leaves);
  }
}

void bitcast(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId value = scalar_or_vector(t, inst.operand(0));
  if (leaf_info(t, inst.result_type).components != components(t, value)) fail(inst, "size of the components changes");
  set_value(t, inst, value);
}

void composite_construct(Translator& t, const Inst& inst, ir::Op) {
  const Type& type = t.module.type(inst.result_type);
  if (type.kind != Type::Kind::kVector) {
    Columns leaves;
    for (std::uint32_t i = 0; inst.has(i); i++) {
      const Columns& part = value_of(t, inst.operand(i)).leaves;
      leaves.insert(leaves.end(), part.begin(), part.end());
    }
    return set_value(t, inst, std::move(leaves));
  }
  std::vector<ir::Src> parts;
  for (std::uint32_t i = 0; inst.has(i); i++) {
    const ir::ValueId part = scalar_or_vector(t, inst.operand(i));
    for (std::uint8_t c = 0; c < components(t, part); c++) parts.push_back(splat(part, c));
  }
  if (parts.size() != type.count) fail(inst, "parts do not fill the vector");
  set_value(t, inst, vec(t, std::move(parts), leaf_info(t, type.id).boolean));
}

void composite_extract(Translator& t, const Inst& inst, ir::Op) {
  const Value& from = value_of(t, inst.operand(0));
  const Part part = find_part(t, inst, from.type, 1);
  if (part.component) return set_value(t, inst, extract(t, from.leaves.at(part.first), *part.component));
  if (part.first + t.module.type(part.type).leaves > from.leaves.size()) fail(inst, "index out of range");
  const auto first = from.leaves.begin() + part.first;
  set_value(t, inst, Columns(first, first + t.module.type(part.type).leaves));
}

void composite_insert(Translator& t, const Inst& inst, ir::Op) {
  const Value object = value_of(t, inst.operand(0));
  Value whole_value = value_of(t, inst.operand(1));
  const Part part = find_part(t, inst, whole_value.type, 2);
  if (part.component) {
    ir::ValueId& leaf = whole_value.leaves.at(part.first);
    leaf = insert(t, leaf, object.leaves.at(0), *part.component);
  } else {
    if (part.first + object.leaves.size() > whole_value.leaves.size() ||
        object.leaves.size() != t.module.type(part.type).leaves)
      fail(inst, "object does not fit");
    std::copy(object.leaves.begin(), object.leaves.end(), whole_value.leaves.begin() + part.first);
  }
  set_value(t, inst, std::move(whole_value.leaves));
}

void vector_shuffle(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  const std::uint32_t split = components(t, a), total = split + components(t, b);
  const bool boolean = is_boolean(t, a);
  std::vector<ir::Src> parts;
  for (std::uint32_t i = 2; inst.has(i); i++) {
    const std::uint32_t c = inst.operand(i);
    if (c != UINT32_MAX && c >= total) fail(inst, "component out of range");
    if (c == UINT32_MAX)
      parts.push_back(whole(undefined(t, 1, boolean)));
    else
      parts.push_back(c < split ? splat(a, static_cast<std::uint8_t>(c))
                                : splat(b, static_cast<std::uint8_t>(c - split)));
  }
  if (parts.size() != leaf_info(t, inst.result_type).components) fail(inst, "components do not fill the vector");
  set_value(t, inst, vec(t, std::move(parts), boolean));
}

void vector_extract_dynamic(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, extract_dynamic(t, scalar_or_vector(t, inst.operand(0)), scalar_or_vector(t, inst.operand(1))));
}

void vector_insert_dynamic(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst,
            insert_dynamic(t, scalar_or_vector(t, inst.operand(0)), scalar_or_vector(t, inst.operand(1)),
                           scalar_or_vector(t, inst.operand(2))));
}

}  // namespace vitrine::spirv::front
