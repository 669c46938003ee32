// Elements of local arrays that are known (nir_opt_copy_prop_vars.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kReadsWhatWasStored[] = {
    {"at the same dynamic index", R"(
Arrays 4
StoreArray %b, %a
StoreOutput FAdd(LoadArray(%b), LoadArray(2))
)",
     R"(
StoreArray %b, %a
%0 = LoadArray 2
%1 = FAdd %a, %0
StoreOutput %1
)"},
    {"stores that nothing reads", R"(
Arrays 4
StoreArray %b, %a
StoreOutput %a
)",
     R"(
StoreOutput %a
)"},
    {"a store of what is there", R"(
Arrays 4
%x = LoadArray %b
StoreArray %b, %x
StoreOutput FAdd(%x, LoadArray(%c))
)",
     R"(
%0 = LoadArray %b
%1 = LoadArray %c
%2 = FAdd %0, %1
StoreOutput %2
)"},
    {"another dynamic index between them", R"(
Arrays 4
StoreArray %b, %a
StoreArray %c, 1.0
StoreOutput LoadArray(%b)
)"},
};

TEST(OptCopyPropArrays, ReadsWhatWasStored) { check_step("opt_copy_prop_arrays", kReadsWhatWasStored); }

}  // namespace
}  // namespace vitrine::spirv::test
