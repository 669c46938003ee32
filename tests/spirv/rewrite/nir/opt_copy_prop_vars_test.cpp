// Words of buffers that were loaded before (nir_opt_copy_prop_vars.c).
#include "tests/spirv/rewrite/pass_case.h"

namespace vitrine::spirv::test {
namespace {

constexpr PassCase kLoadsBecomeComponents[] = {
    {"a component of a push constant", R"(
%v:2 = LoadPush 0
%y = LoadPush 4
StoreOutput FAdd(%v.x, %y)
)",
     R"(
%0:2 = LoadPush 0
%1 = Vec %0.y
%2 = FAdd %0.x, %1
StoreOutput %2
)"},
    {"a word of a uniform buffer at the same dynamic offset", R"(
%v:2 = LoadUniform 0, %a [0 0 1]
%y = LoadUniform 0, %a [0 0 1 4]
StoreOutput FAdd(%v.x, %y)
)",
     R"(
%0:2 = LoadUniform 0, %a [0 0 1]
%1 = Vec %0.y
%2 = FAdd %0.x, %1
StoreOutput %2
)"},
    {"another slot", R"(
%v:2 = LoadUniform 0, %a [0 0 1]
%y = LoadUniform 0, %a [0 1 1 4]
StoreOutput FAdd(%v.x, %y)
)"},
    {"a storage buffer that was written", R"(
%x = LoadStorage 0, 0 [0 0 1]
StoreStorage 0, %b, %a [0 1 1] {1}
%y = LoadStorage 0, 0 [0 0 1]
StoreOutput FAdd(%x, %y)
)"},
};

TEST(OptCopyPropVars, LoadsBecomeComponents) { check_step("opt_copy_prop_vars", kLoadsBecomeComponents); }

}  // namespace
}  // namespace vitrine::spirv::test
