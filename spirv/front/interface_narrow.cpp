// Numbers of 16 bits between stages (storageInputOutput16). Vulkan 1.3.239, Component Assignment: a scalar of 16 bits
// takes a component of 32, and there it lies as the number of 32 bits that has its value, so that fixed function knows
// no other: attributes are fetched, varyings interpolated and attachments written in 32 bits.
#include "spirv/front/expression.h"
#include "spirv/front/interface.h"

namespace vitrine::spirv::front {
namespace {

constexpr std::uint8_t kNarrow = 16;

Expr converted(const Type& number, const Expr& value, std::uint8_t width) {
  if (number.kind == Type::Kind::kFloat) return convert_float(value, width);
  return number.is_signed ? convert_signed(value, width) : convert_unsigned(value, width);
}

}  // namespace

ir::ValueId to_interface(Translator& t, std::uint32_t type, ir::ValueId value) {
  const Type& number = number_type(t, type);
  if (number.width != kNarrow) return value;
  Expr narrow{&t, value};
  narrow.width = kNarrow;
  return converted(number, narrow, 32).id;
}

ir::ValueId from_interface(Translator& t, std::uint32_t type, ir::ValueId value) {
  const Type& number = number_type(t, type);
  return number.width == kNarrow ? converted(number, {&t, value}, kNarrow).id : value;
}

}  // namespace vitrine::spirv::front
