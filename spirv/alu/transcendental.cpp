// Wave handlers of exp2, log2, pow, sin and cos.
#include "spirv/alu/family.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/alu/transcendental.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/transcendental_ops-inl.h"
#include "spirv/alu/wave_handlers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Family transcendental_handlers() { return kHandlers.data(); }

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {

HWY_EXPORT(transcendental_handlers);

Family transcendental_family() { return HWY_DYNAMIC_DISPATCH(transcendental_handlers)(); }

}  // namespace vitrine::spirv::alu
#endif  // HWY_ONCE
