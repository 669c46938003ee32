// Planted races of shared memory: inside of a wave, between waves, with barriers that do not do, and atomic operations.
#include "tests/glass/race_catalogue.h"

namespace vitrine::glass::test {
namespace {

constexpr PlantedRace kPlanted[] = {
    {"neighbour", "race-shared", 8, 1, "shared uint s[8];", "#s[i] = i;\n@OUT(s[i ^ 1u]);",
     "s[i] = i;\nbarrier();\nOUT(s[i ^ 1u]);"},
    {"neighbour_in_a_full_wave", "race-shared", 64, 1, "shared uint s[64];", "#s[i] = i;\n@OUT(s[i ^ 1u]);",
     "s[i] = i;\nbarrier();\nOUT(s[i ^ 1u]);"},
    {"neighbour_in_many_workgroups", "race-shared", 64, 9, "shared uint s[64];", "#s[i] = i;\n@OUT(s[i ^ 1u]);",
     "s[i] = i;\nbarrier();\nOUT(s[i ^ 1u]);"},
    {"in_one_of_many_workgroups", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\nif (g != 7u) barrier();\n@uint x = s[i ^ 1u];\nif (g == 7u) o[i] = x;",
     "s[i] = i;\nbarrier();\nuint x = s[i ^ 1u];\nif (g == 7u) o[i] = x;"},
    {"store_of_one_of_many_workgroups", "race-shared", 128, 9, "shared uint s[128];",
     "s[i] = 1u;\nbarrier();\n#s[i] = 2u;\nuint at = g == 6u ? i ^ 64u : i;\n@s[at] += 3u;\nbarrier();\nOUT(s[i]);",
     "s[i] = 1u;\nbarrier();\ns[i] = 2u;\nuint at = g == 16u ? i ^ 64u : i;\ns[at] += 3u;\nbarrier();\nOUT(s[i]);"},
    {"behind_a_bound_of_one_of_many_workgroups", "race-shared", 128, 9, "shared uint s[128];",
     "s[i] = 1u;\nbarrier();\nif (g == 8u && i < 3u) return;\n@if (g == 8u) s[127u] = 2u;\nbarrier();\nOUT(s[i]);",
     "s[i] = 1u;\nbarrier();\nif (g == 8u && i < 3u) return;\nif (g == 8u && i == 9u) s[127u] = "
     "2u;\nbarrier();\nOUT(s[i]);"},
    {"other_wave", "race-shared", 128, 1, "shared uint s[128];", "@s[i] = i;\n#OUT(s[127u - i]);",
     "s[i] = i;\nbarrier();\nOUT(s[127u - i]);"},
    {"third_wave", "race-shared", 192, 3, "shared uint s[192];", "@s[i] = i;\n#OUT(s[191u - i]);",
     "s[i] = i;\nbarrier();\nOUT(s[191u - i]);"},
    {"memory_barrier_alone", "race-shared", 64, 1, "shared uint s[64];",
     "#s[i] = i;\nmemoryBarrierShared();\n@OUT(s[63u - i]);",
     "s[i] = i;\nmemoryBarrierShared();\nbarrier();\nOUT(s[63u - i]);"},
    {"group_memory_barrier_alone", "race-shared", 64, 1, "shared uint s[64];",
     "#s[i] = i;\ngroupMemoryBarrier();\n@OUT(s[63u - i]);",
     "s[i] = i;\ngroupMemoryBarrier();\nbarrier();\nOUT(s[63u - i]);"},
    {"all_memory_barriers_alone", "race-shared", 128, 1, "shared uint s[128];",
     "@s[i] = i;\nmemoryBarrier();\n#OUT(s[127u - i]);", "s[i] = i;\nmemoryBarrier();\nbarrier();\nOUT(s[127u - i]);"},
    {"write_behind_a_read", "race-shared", 64, 1, "shared uint s[64];",
     "s[i] = i;\nbarrier();\n#uint x = s[i ^ 3u];\n@s[i] = x;\nbarrier();\nOUT(s[i]);",
     "s[i] = i;\nbarrier();\nuint x = s[i ^ 3u];\nbarrier();\ns[i] = x;\nbarrier();\nOUT(s[i]);"},
    {"write_behind_a_read_of_another_wave", "race-shared", 128, 1, "shared uint s[128];",
     "s[i] = i;\nbarrier();\n@uint x = s[i ^ 64u];\n#s[i] = x + 1u;\nbarrier();\nOUT(s[i]);",
     "s[i] = i;\nbarrier();\nuint x = s[i ^ 64u];\nbarrier();\ns[i] = x + 1u;\nbarrier();\nOUT(s[i]);"},
    {"all_write_one_word", "race-shared", 8, 1, "shared uint s[8];", "@s[0] = i;\nbarrier();\nOUT(s[i & 7u]);",
     "if (i == 0u) s[0] = i;\nbarrier();\nOUT(s[i & 7u]);"},
    {"all_write_one_value", "race-shared", 8, 1, "shared uint s[8];", "@s[0] = 7u;\nbarrier();\nOUT(s[i & 7u]);",
     "if (i == 7u) s[0] = 7u;\nbarrier();\nOUT(s[i & 7u]);"},
    {"two_write_one_word", "race-shared", 64, 1, "shared uint s[64];", "@s[i / 2u] = i;\nbarrier();\nOUT(s[i]);",
     "if (i < 32u) s[i] = i;\nbarrier();\nOUT(s[i]);"},
    {"waves_write_one_word", "race-shared", 128, 1, "shared uint s[64];", "@s[i & 63u] = i;\nbarrier();\nOUT(s[i]);",
     "if (i < 64u) s[i & 63u] = i;\nbarrier();\nOUT(s[i]);"},
    {"two_stores", "race-shared", 64, 1, "shared uint s[65];", "#s[i] = i;\n@s[i + 1u] = 3u;\nbarrier();\nOUT(s[i]);",
     "s[i] = i;\nbarrier();\ns[i + 1u] = 3u;\nbarrier();\nOUT(s[i]);"},
    {"reduction_without_barriers", "race-shared", 64, 1, "shared uint s[64];",
     "s[i] = i;\nbarrier();\nfor (uint k = 32u; k > 0u; k /= 2u)\n@if (i < k) s[i] += s[i + "
     "k];\nbarrier();\nOUT(s[0]);",
     "s[i] = i;\nbarrier();\nfor (uint k = 32u; k > 0u; k /= 2u) {\nif (i < k) s[i] += s[i + "
     "k];\nbarrier();\n}\nbarrier();\nOUT(s[0]);"},
    {"reduction_without_the_first_barrier", "race-shared", 64, 1, "shared uint s[64];",
     "#s[i] = i;\nfor (uint k = 32u; k > 0u; k /= 2u) {\n@if (i < k) s[i] += s[i + "
     "k];\nbarrier();\n}\nbarrier();\nOUT(s[0]);",
     "s[i] = i;\nfor (uint k = 32u; k > 0u; k /= 2u) {\nbarrier();\nif (i < k) s[i] += s[i + "
     "k];\n}\nbarrier();\nOUT(s[0]);"},
    {"sum_with_one_barrier", "race-shared", 64, 1, "shared uint s[64];",
     "s[i] = i;\nfor (uint k = 1u; k < 64u; k *= 2u) {\nbarrier();\n#uint x = i >= k ? s[i - k] : 0u;\n@s[i] += "
     "x;\n}\nbarrier();\nOUT(s[i]);",
     "s[i] = i;\nfor (uint k = 1u; k < 64u; k *= 2u) {\nbarrier();\nuint x = i >= k ? s[i - k] : 0u;\nbarrier();\n"
     "s[i] += x;\n}\nbarrier();\nOUT(s[i]);"},
    {"transposed_tile", "race-shared", 64, 1, "shared uint s[8][8];",
     "#s[i / 8u][i % 8u] = i;\n@OUT(s[i % 8u][i / 8u]);",
     "s[i / 8u][i % 8u] = i;\nbarrier();\nOUT(s[i % 8u][i / 8u]);"},
    {"member_of_a_structure", "race-shared", 64, 1, "struct T { uint a, b; };\nshared T s[64];",
     "s[i].a = i;\n#s[i].b = 2u;\n@OUT(s[63u - i].b + s[i].a);",
     "s[i].a = i;\ns[i].b = 2u;\nbarrier();\nOUT(s[63u - i].b + s[i].a);"},
    {"vectors", "race-shared", 64, 1, "shared uvec4 s[64];", "#s[i] = uvec4(i);\n@OUT(s[63u - i].y);",
     "s[i] = uvec4(i);\nbarrier();\nOUT(s[63u - i].y);"},
    {"component_of_a_vector", "race-shared", 16, 1, "shared uvec4 s[4];",
     "#s[i / 4u][i % 4u] = i;\n@OUT(s[3u - i / 4u].x);", "s[i / 4u][i % 4u] = i;\nbarrier();\nOUT(s[3u - i / 4u].x);"},
    {"in_a_function", "race-shared", 64, 1, "shared uint s[64];\nuint of(uint at) {\n@return s[at];\n}",
     "#s[i] = i;\nOUT(of(i ^ 5u));", "s[i] = i;\nbarrier();\nOUT(of(i ^ 5u));"},
    {"first_invocation_writes", "race-shared", 64, 1, "shared uint s;", "if (i == 0u)\n#s = 5u;\n@OUT(s);",
     "if (i == 0u)\ns = 5u;\nbarrier();\nOUT(s);"},
    {"first_invocation_writes_for_waves", "race-shared", 128, 1, "shared uint s, t[128];",
     "if (i == 0u)\n#s = 5u;\n@t[i] = s;\nbarrier();\nOUT(t[i]);",
     "if (i == 0u)\ns = 5u;\nbarrier();\nt[i] = s;\nbarrier();\nOUT(t[i]);"},
    {"barrier_too_early", "race-shared", 64, 1, "shared uint s[64];", "barrier();\n#s[i] = i;\n@OUT(s[63u - i]);",
     "barrier();\ns[i] = i;\nbarrier();\nOUT(s[63u - i]);"},
    {"double_buffer_of_one", "race-shared", 64, 1, "shared uint s[2][64];",
     "s[0][i] = i;\ns[1][i] = i;\nbarrier();\nfor (uint k = 0u; k < 3u; ++k) {\n#uint x = s[0][i ^ 1u];\n@s[0][i] = x "
     "+ 1u;\nbarrier();\n}\nbarrier();\nOUT(s[0][i]);",
     "s[0][i] = i;\ns[1][i] = i;\nbarrier();\nfor (uint k = 0u; k < 3u; ++k) {\nuint x = s[k & 1u][i ^ 1u];\n"
     "s[~k & 1u][i] = x + 1u;\nbarrier();\n}\nbarrier();\nOUT(s[0][i]);"},
    {"atomic_and_load", "race-shared", 64, 1, "shared uint s;",
     "if (i == 0u) s = 0u;\nbarrier();\n#atomicAdd(s, 1u);\n@OUT(s);",
     "if (i == 0u) s = 0u;\nbarrier();\natomicAdd(s, 1u);\nbarrier();\nOUT(s);"},
    {"store_and_atomic", "race-shared", 64, 1, "shared uint s;", "if (i == 0u)\n#s = 0u;\n@atomicAdd(s, 1u);",
     "if (i == 0u)\ns = 0u;\nbarrier();\natomicAdd(s, 1u);"},
    {"histogram_without_atomics", "race-shared", 64, 1, "shared uint s[4];",
     "if (i < 4u) s[i] = 0u;\nbarrier();\n@s[i % 4u] += 1u;\nbarrier();\nOUT(s[i & 3u]);",
     "if (i < 4u) s[i] = 0u;\nbarrier();\natomicAdd(s[i % 4u], 1u);\nbarrier();\nOUT(s[i & 3u]);"},
    {"subgroup_without_a_barrier", "race-shared", 64, 1, "shared uint s[64];", "#s[i] = i;\n@OUT(s[i ^ 1u]);",
     "s[i] = i;\nsubgroupBarrier();\nOUT(s[i ^ 1u]);"},
    {"subgroup_memory_barrier_alone", "race-shared", 64, 1, "shared uint s[64];",
     "#s[i] = i;\nsubgroupMemoryBarrierShared();\n@OUT(s[i ^ 1u]);", "s[i] = i;\nsubgroupBarrier();\nOUT(s[i ^ 1u]);"},
    {"subgroup_barrier_for_two_subgroups", "race-shared", 128, 1, "shared uint s[128];",
     "@s[i] = i;\nsubgroupBarrier();\n#OUT(s[127u - i]);", "s[i] = i;\nsubgroupBarrier();\nOUT(s[63u - i]);"},
    {"barrier_of_the_wrong_memory", "race-shared", 64, 1, "shared uint s[64];",
     "#s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsBuffer, "
     "gl_SemanticsAcquireRelease);\n@OUT(s[63u - i]);",
     "s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsAcquireRelease);\nOUT(s[63u - i]);"},
    {"barrier_without_semantics", "race-shared", 64, 1, "shared uint s[64];",
     "#s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, 0, 0);\n@OUT(s[63u - i]);",
     "s[i] = i;\nmemoryBarrierShared();\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, 0, 0);\nOUT(s[63u - "
     "i]);"},
    {"barrier_of_a_subgroup_in_name", "race-shared", 128, 1, "shared uint s[128];",
     "@s[i] = i;\ncontrolBarrier(gl_ScopeSubgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsAcquireRelease);\n#OUT(s[127u - i]);",
     "s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsAcquireRelease);\nOUT(s[127u - i]);"},
    {"barrier_whose_memory_is_too_near", "race-shared", 128, 1, "shared uint s[128];",
     "#s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeSubgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsAcquireRelease);\n@OUT(s[127u - i]);",
     "s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsAcquireRelease);\nOUT(s[127u - i]);"},
    {"barrier_that_only_releases", "race-shared", 128, 1, "shared uint s[128];",
     "#s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsRelease);\n"
     "@OUT(s[127u - i]);",
     "s[i] = i;\ncontrolBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, "
     "gl_SemanticsAcquireRelease);\nOUT(s[127u - i]);"},
    {"exchange_that_acquires_nothing", "race-shared", 8, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n#s = 5u;\n"
     "atomicExchange(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicExchange(flag, 2u) == 1u)\n@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\n"
     "atomicExchange(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicExchange(flag, 2u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == "
     "1u)\n"
     "OUT(s);"},
    {"relaxed_flag_of_a_subgroup", "race-shared", 128, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n#s = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeSubgroup, 0, 0);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeSubgroup, 0, 0) == 1u)\n@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeSubgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeSubgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == 1u)\n"
     "OUT(s);"},
    {"relaxed_flag", "race-shared", 8, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n#s = 5u;\natomicExchange(flag, 1u);\n}\n"
     "if (i == 1u && atomicOr(flag, 0u) == 1u)\n@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == 1u)\n"
     "OUT(s);"},
    {"flag_without_acquire", "race-shared", 8, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n#s = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, 0, 0) == 1u)\n@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, 0, 0) == 1u) {\nmemoryBarrierShared();\nOUT(s);\n}"},
    {"flag_without_release", "race-shared", 8, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n#s = 5u;\natomicStore(flag, 1u, gl_ScopeWorkgroup, 0, "
     "0);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == 1u)\n"
     "@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\nmemoryBarrierShared();\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, 0, 0);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == 1u)\n"
     "OUT(s);"},
    {"flag_in_front_of_the_data", "race-shared", 8, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n#s = 5u;\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == 1u)\n"
     "@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u && atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire) == 1u)\n"
     "OUT(s);"},
    {"another_reads_behind_the_flag", "race-shared", 8, 1, "shared uint s, flag;",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\n#s = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u) atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire);\n"
     "if (i == 2u)\n@OUT(s);",
     "if (i == 0u) flag = 0u;\nbarrier();\nif (i == 0u) {\ns = 5u;\n"
     "atomicStore(flag, 1u, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsRelease);\n}\n"
     "if (i == 1u) atomicLoad(flag, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquire);\nbarrier();\n"
     "if (i == 2u)\nOUT(s);"},
    // ---- in the last of nine workgroups alone: nothing is to be concluded from the others (o[i] is i, v[i], too)
    {"barrier_but_in_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\nif (g < 8u) barrier();\n@if (s[i ^ 1u] == 999u) o[i] = 1u;",
     "s[i] = i;\nif (g < 9u) barrier();\nif (s[i ^ 1u] == 999u) o[i] = 1u;"},
    {"offset_of_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\n@if (s[i ^ g / 8u] == 999u) o[i] = 1u;", "s[i] = i;\nif (s[i ^ g / 9u] == 999u) o[i] = 1u;"},
    {"offset_from_a_buffer", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\n@if (s[i ^ v[g] / 8u] == 999u) o[i] = 1u;", "s[i] = i;\nif (s[i ^ v[g] / 9u] == 999u) o[i] = 1u;"},
    {"turns_of_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\nfor (uint k = 0u; k < g / 8u; ++k)\n@if (s[i ^ 1u] == 999u) o[i] = 1u;",
     "s[i] = i;\nfor (uint k = 0u; k < g / 9u; ++k) if (s[i ^ 1u] == 999u) o[i] = 1u;"},
    {"return_but_of_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\nfor (;;) {\nif (g < 8u) return;\n@if (s[i ^ 1u] == 999u) o[i] = 1u;\nbreak;\n}",
     "s[i] = i;\nfor (;;) {\nif (g < 9u) return;\nif (s[i ^ 1u] == 999u) o[i] = 1u;\nbreak;\n}"},
    {"break_but_of_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64];",
     "#s[i] = i;\nuint k = 0u;\nfor (; k < 4u; ++k) if (g < 8u && k == 1u) break;\n"
     "@if (s[i ^ k / 4u] == 999u) o[i] = 1u;",
     "s[i] = i;\nuint k = 0u;\nfor (; k < 4u; ++k) if (g < 9u && k == 1u) break;\n"
     "if (s[i ^ k / 4u] == 999u) o[i] = 1u;"},
    {"array_of_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64];",
     "uint a[8];\nfor (uint k = 0u; k < 8u; ++k) a[k] = 0u;\na[g & 7u] = g / 8u;\n#s[i] = i;\n"
     "@if (s[i ^ a[g & 7u]] == 999u) o[i] = 1u;",
     "uint a[8];\nfor (uint k = 0u; k < 8u; ++k) a[k] = 0u;\na[g & 7u] = g / 9u;\ns[i] = i;\n"
     "if (s[i ^ a[g & 7u]] == 999u) o[i] = 1u;"},
    {"value_from_the_last_workgroup", "race-shared", 64, 9, "shared uint s[64], t;",
     "if (i == 0u) t = g / 8u;\nbarrier();\n#s[i] = i;\n@if (s[i ^ t] == 999u) o[i] = 1u;",
     "if (i == 0u) t = g / 9u;\nbarrier();\ns[i] = i;\nif (s[i ^ t] == 999u) o[i] = 1u;"},
    // ---- in all of them
    {"in_all_of_nine_workgroups", "race-shared", 64, 9,
     "shared uint s[64];\nlayout(push_constant) uniform C { uvec2 at; uint one; };",
     "#s[i] = i;\n@if (s[i ^ one] == 999u) o[i] = 1u;", "s[i] = i;\nbarrier();\nif (s[i ^ one] == 999u) o[i] = 1u;"},
};

class RaceShared : public testing::TestWithParam<PlantedRace> {};

TEST_P(RaceShared, IsFoundWithBothLines) { expect_race(GetParam()); }

TEST_P(RaceShared, TwinIsSilent) { expect_no_race(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Catalogue, RaceShared, testing::ValuesIn(kPlanted), race_name);

}  // namespace
}  // namespace vitrine::glass::test
