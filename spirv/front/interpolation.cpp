// interpolateAt*: fragment inputs evaluated elsewhere than where their qualifiers say (GLSL.std.450 76 to 78). Planes
// come from raster; lavapipe-rasterization.md 4.2 says in which order they are evaluated.
#include "spirv/front/expression.h"
#include "spirv/front/glsl450.h"
#include "spirv/front/interface.h"

namespace vitrine::spirv::front::glsl {
namespace {

constexpr std::uint8_t kMaxSamples = 8;

/// A value that raster supplies, loaded in front of the body.
Expr prologue_input(Translator& t, const InterfaceSlot& slot) {
  ir::NodeList* const list = std::exchange(t.list, &t.prologue);
  const Expr value{&t, load_input(t, slot)};
  t.list = list;
  return value;
}

Expr place_input(Translator& t, BuiltIn built_in, std::uint8_t component) {
  InterfaceSlot slot;
  slot.built_in = built_in;
  slot.component = component;
  return prologue_input(t, slot);
}

/// a * b + c with one rounding. The rewrites leave this operation alone, as they leave alone what is one instruction to
/// the reference: sums and products of this file are written with it too.
Expr fused(Expr a, Expr b, Expr c) { return apply(ir::Op::kFFused, {a, b, c}); }

/// Point of evaluation, in pixels.
struct Place {
  Expr x, y;
};

Place place_of_offset(Translator& t, Expr offset) {
  const Expr one = imm(t, 1.0f);
  return {fused(offset[0], one, place_input(t, BuiltIn::kInterpolationCenter, 0)),
          fused(offset[1], one, place_input(t, BuiltIn::kInterpolationCenter, 1))};
}

/// A sample number out of range means the last.
Place place_of_sample(Translator& t, Expr sample) {
  if (const auto* words = constant_of(t, sample.id)) {
    const auto s = static_cast<std::uint8_t>(std::min<std::uint32_t>((*words)[0], kMaxSamples - 1));
    return {place_input(t, BuiltIn::kInterpolationSample, static_cast<std::uint8_t>(2 * s)),
            place_input(t, BuiltIn::kInterpolationSample, static_cast<std::uint8_t>(2 * s + 1))};
  }
  Place place = {place_input(t, BuiltIn::kInterpolationSample, 2 * kMaxSamples - 2),
                 place_input(t, BuiltIn::kInterpolationSample, 2 * kMaxSamples - 1)};
  for (std::uint8_t s = 0; s + 1 < kMaxSamples; s++) {
    const Expr here = apply(ir::Op::kIEq, {sample, imm_u32(t, s)});
    place.x = select(here, place_input(t, BuiltIn::kInterpolationSample, static_cast<std::uint8_t>(2 * s)), place.x);
    place.y =
        select(here, place_input(t, BuiltIn::kInterpolationSample, static_cast<std::uint8_t>(2 * s + 1)), place.y);
  }
  return place;
}

bool is_interpolated(const InterfaceSlot& slot) {
  const bool numbered = slot.built_in == BuiltIn::kNone || slot.built_in == BuiltIn::kClipDistance ||
                        slot.built_in == BuiltIn::kCullDistance || slot.built_in == BuiltIn::kBaryCoord ||
                        slot.built_in == BuiltIn::kBaryCoordNoPersp;
  return numbered && slot.interpolation != Interpolation::kFlat;
}

/// One component; `place` null: at the centroid.
Expr component_at(Translator& t, InterfaceSlot slot, const Place* place) {
  if (!is_interpolated(slot)) return prologue_input(t, slot);
  if (place == nullptr) {
    slot.sample_location = SampleLocation::kCentroid;
    return prologue_input(t, slot);
  }
  slot.sample_location = SampleLocation::kCenter;
  auto part = [&](InputPart wanted) {
    slot.part = wanted;
    return prologue_input(t, slot);
  };
  const Expr row = fused(part(InputPart::kPlaneX), place->x, part(InputPart::kPlaneOrigin));
  const Expr value = fused(part(InputPart::kPlaneY), place->y, row);
  if (slot.interpolation == Interpolation::kLinear) return value;
  return fused(value, place_input(t, BuiltIn::kInterpolationScale, 0), imm(t, -0.0f));
}

/// Whether an access chain may lead to the leaf at `path`.
bool reaches(const std::vector<Step>& chain, const std::vector<Step>& path) {
  for (std::size_t i = 0; i < std::min(chain.size(), path.size()); i++)
    if (!chain[i].dynamic && chain[i].index != path[i].index) return false;
  return true;
}

/// The interpolated leaves go to a variable like the input, which is then read as the access chain says.
void interpolate(Translator& t, const Inst& inst, const Place* place) {
  const Pointer interpolant = pointer_of(t, inst.operand(2));
  if (interpolant.kind != Pointer::Kind::kLocal || t.locals[interpolant.local].storage != spv::StorageClass::Input)
    fail(inst, "the interpolant is not an input");
  const Local input = t.locals[interpolant.local];
  Pointer copy = interpolant;
  copy.local = new_local(t, input.type, spv::StorageClass::Function, 0);
  for (const Leaf& leaf : interface_leaves(t, input)) {
    if (!reaches(interpolant.path, leaf.path)) continue;
    if (t.module.type(leaf.type).leaves != 1) fail(inst, "the interpolant is not of 32-bit numbers");
    std::vector<ir::Src> parts;
    for (std::uint8_t c = 0; c < leaf_info(t, leaf.type).components; c++) {
      InterfaceSlot slot = leaf.slot;
      slot.component = static_cast<std::uint8_t>(slot.component + c);
      parts.push_back(whole(component_at(t, slot, place).id));
    }
    Pointer target = copy;
    target.path = leaf.path;
    target.component.reset();
    target.type = leaf.type;
    store(t, target, {leaf.type, {from_interface(t, leaf.type, vec(t, std::move(parts), false))}});
  }
  set_value(t, inst, load(t, copy).leaves);
}

}  // namespace

void interpolate_at_centroid(Translator& t, const Inst& inst, ir::Op) { interpolate(t, inst, nullptr); }

void interpolate_at_sample(Translator& t, const Inst& inst, ir::Op) {
  const Expr sample{&t, number(t, inst.operand(3))};
  const Place place = place_of_sample(t, sample);
  interpolate(t, inst, &place);
}

void interpolate_at_offset(Translator& t, const Inst& inst, ir::Op) {
  const Expr offset{&t, number(t, inst.operand(3), 2)};
  const Place place = place_of_offset(t, offset);
  interpolate(t, inst, &place);
}

}  // namespace vitrine::spirv::front::glsl
