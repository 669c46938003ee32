// Wave handlers of comparisons, moves and selections.
#include "spirv/alu/family.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/alu/compare.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/compare_ops-inl.h"
#include "spirv/alu/wave_handlers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Family compare_handlers() { return kHandlers.data(); }

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {

HWY_EXPORT(compare_handlers);

Family compare_family() { return HWY_DYNAMIC_DISPATCH(compare_handlers)(); }

}  // namespace vitrine::spirv::alu
#endif  // HWY_ONCE
