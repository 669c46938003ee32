// Wave handlers of integer arithmetic and bit operations.
#include "spirv/alu/family.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/alu/integer.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/integer_ops-inl.h"
#include "spirv/alu/wave_handlers-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Family integer_handlers() { return kHandlers.data(); }

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {

HWY_EXPORT(integer_handlers);

Family integer_family() { return HWY_DYNAMIC_DISPATCH(integer_handlers)(); }

}  // namespace vitrine::spirv::alu
#endif  // HWY_ONCE
