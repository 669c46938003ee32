// Pointers as values: variable pointers into storage buffers and workgroup memory (SPIR-V assembly), and device
// addresses (GLSL's buffer references).
#include "harness/case.h"
#include "harness/run.h"
#include "harness/shader.h"
#include "tests/spirv/compute_text.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kInvocations = 64;

// ---- variable pointers

/// 64 invocations of a body that makes %r from %x (a random word) and %n (their number). Buffers: %a and %b of 256
/// random words, %out.
void run_body(Run& run, const std::string& body, const std::string& declarations = "", bool newer = false) {
  run.require(run.gpu.extension_features.variablePointers, "variablePointers");
  if (newer) run.require(run.gpu.has("VK_KHR_spirv_1_4"), "VK_KHR_spirv_1_4");
  ComputeText module;
  module.capabilities = "OpCapability VariablePointers\n";
  if (newer) module.interface = "%a %b %out %shared";
  module.buffers = {"a", "b", "out"};
  module.annotations = "OpDecorate %uint_ptr ArrayStride 4\n";
  module.declarations = R"(
%u2 = OpConstant %uint 2
%u3 = OpConstant %uint 3
%u7 = OpConstant %uint 7
%u64 = OpConstant %uint 64
%u264 = OpConstant %uint 264
%shared_array = OpTypeArray %uint %u64
%shared_type = OpTypePointer Workgroup %shared_array
%shared_ptr = OpTypePointer Workgroup %uint
%shared = OpVariable %shared_type Workgroup
%local_ptr = OpTypePointer Function %uint_ptr
%null = OpConstantNull %uint_ptr
%pick_type = OpTypeFunction %uint_ptr %bool %uint_ptr
)" + declarations;
  module.locals = "%kept = OpVariable %local_ptr Function\n";
  module.body = load_word("%x", "a") + R"(
%bit = OpBitwiseAnd %uint %x %u1
%odd = OpIEqual %bool %bit %u1
%pa = OpAccessChain %uint_ptr %a %u0 %n
%pb = OpAccessChain %uint_ptr %b %u0 %n
)" + body + store_word("%r", "out");
  const std::string text = (newer ? "; target: spirv1.4\n" : "; target: vulkan1.1\n") + module.text();
  run.note("assembly", text);
  std::vector<uint32_t> words(256);
  for (uint32_t& word : words) word = run.random.bits();
  const Buffer a = run.buffer_of(words);
  for (uint32_t& word : words) word = run.random.bits();
  const Buffer b = run.buffer_of(words), out = run.buffer(kInvocations * 4);
  const Resources res = run.resources({storage_buffer(0, a), storage_buffer(1, b), storage_buffer(2, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.module(assemble_spirv(text)));
  run.dispatch(res, pipeline, 1);
  run.out("out", out);
  run.out("b", b);
}

CTS_CASE("pointers", "variable.select_buffers") {
  run_body(run, R"(
%p = OpSelect %uint_ptr %odd %pa %pb
%v = OpLoad %uint %p
%r = OpIAdd %uint %v %n
)");
}

CTS_CASE("pointers", "variable.select_same_buffer") {
  run_body(run, R"(
%far = OpAccessChain %uint_ptr %b %u0 %u7
%p = OpSelect %uint_ptr %odd %far %pb
%v = OpLoad %uint %p
%r = OpIAdd %uint %v %n
)");
}

CTS_CASE("pointers", "variable.store_and_atomic") {
  run_body(run, R"(
%own = OpIAdd %uint %n %u64
%pc = OpAccessChain %uint_ptr %b %u0 %own
%p = OpSelect %uint_ptr %odd %pb %pc
OpStore %p %x
%slot = OpBitwiseAnd %uint %n %u3
%q0 = OpAccessChain %uint_ptr %b %u0 %slot
%q1 = OpPtrAccessChain %uint_ptr %q0 %u264
%q2 = OpPtrAccessChain %uint_ptr %q0 %u64
%q3 = OpPtrAccessChain %uint_ptr %q2 %u64
%q = OpSelect %uint_ptr %odd %q3 %q1
%r = OpIAdd %uint %x %u1
)");
}

CTS_CASE("pointers", "variable.phi_walks_an_array") {
  run_body(run, R"(
%start = OpSelect %uint_ptr %odd %pa %pb
%trips = OpBitwiseAnd %uint %x %u7
OpBranch %head
%head = OpLabel
%p = OpPhi %uint_ptr %start %entry %next %again
%sum = OpPhi %uint %u0 %entry %sum1 %again
%k = OpPhi %uint %u0 %entry %k1 %again
OpLoopMerge %done %again None
OpBranch %test
%test = OpLabel
%more = OpULessThan %bool %k %trips
OpBranchConditional %more %again %done
%again = OpLabel
%v = OpLoad %uint %p
%scaled = OpIMul %uint %sum %u3
%sum1 = OpIAdd %uint %scaled %v
%next = OpPtrAccessChain %uint_ptr %p %u2
%k1 = OpIAdd %uint %k %u1
OpBranch %head
%done = OpLabel
%r = OpIAdd %uint %sum %n
)");
}

CTS_CASE("pointers", "variable.kept_and_returned") {
  run_body(run, R"(
OpStore %kept %pb
OpSelectionMerge %joined None
OpBranchConditional %odd %then %joined
%then = OpLabel
OpStore %kept %pa
OpBranch %joined
%joined = OpLabel
%k = OpLoad %uint_ptr %kept
%p = OpFunctionCall %uint_ptr %pick %odd %k
%v = OpLoad %uint %p
%r = OpIAdd %uint %v %n
)",
           R"(
%pick = OpFunction %uint_ptr None %pick_type
%flag = OpFunctionParameter %bool
%given = OpFunctionParameter %uint_ptr
%pick_entry = OpLabel
OpSelectionMerge %rest None
OpBranchConditional %flag %early %rest
%early = OpLabel
%further = OpPtrAccessChain %uint_ptr %given %u3
OpReturnValue %further
%rest = OpLabel
OpReturnValue %given
OpFunctionEnd
)");
}

CTS_CASE("pointers", "variable.compare") {
  run_body(run, R"(
%other = OpAccessChain %uint_ptr %a %u0 %n
%p = OpSelect %uint_ptr %odd %other %pb
%same = OpIEqual %bool %n %n
%loaded = OpLoad %uint %p
%chosen = OpSelect %uint_ptr %odd %p %pa
%w = OpLoad %uint %chosen
%r = OpIAdd %uint %loaded %w
)");
}

/// The chosen pointer leads to an array of blocks, which is indexed afterwards.
CTS_CASE("pointers", "variable.select_arrays_of_blocks") {
  run.require(run.gpu.extension_features.variablePointers, "variablePointers");
  ComputeText module;
  module.capabilities = "OpCapability VariablePointers\n";
  module.buffers = {"out"};
  module.annotations = R"(
OpDecorate %a DescriptorSet 0
OpDecorate %a Binding 1
OpDecorate %b DescriptorSet 0
OpDecorate %b Binding 2
)";
  module.declarations = R"(
%u2 = OpConstant %uint 2
%blocks = OpTypeArray %block %u2
%blocks_ptr = OpTypePointer StorageBuffer %blocks
%a = OpVariable %blocks_ptr StorageBuffer
%b = OpVariable %blocks_ptr StorageBuffer
)";
  module.body = R"(
%g = OpUDiv %uint %n %u2
%bit = OpBitwiseAnd %uint %g %u1
%odd = OpIEqual %bool %bit %u1
%chosen = OpSelect %blocks_ptr %odd %a %b
%first = OpAccessChain %uint_ptr %chosen %u0 %u0 %n
%second = OpAccessChain %uint_ptr %chosen %u1 %u0 %n
%v = OpLoad %uint %first
%w = OpLoad %uint %second
%w2 = OpShiftLeftLogical %uint %w %u1
%r = OpIAdd %uint %v %w2
)" + store_word("%r", "out");
  std::vector<Buffer> buffers;
  for (int i = 0; i < 4; ++i) {
    std::vector<uint32_t> words(kInvocations);
    for (uint32_t& word : words) word = run.random.bits();
    buffers.push_back(run.buffer_of(words));
  }
  const auto two = [&](uint32_t binding, const Buffer& first, const Buffer& second) {
    Binding both = storage_buffer(binding, first);
    both.buffers.push_back(storage_buffer(binding, second).buffers[0]);
    return both;
  };
  const Buffer out = run.buffer(kInvocations * 4);
  const Resources res =
      run.resources({storage_buffer(0, out), two(1, buffers[0], buffers[1]), two(2, buffers[2], buffers[3])});
  const VkPipeline pipeline =
      run.compute(res.layout, run.module(assemble_spirv("; target: vulkan1.1\n" + module.text())));
  run.dispatch(res, pipeline, 1);
  run.out("out", out);
}

CTS_CASE("pointers", "variable.difference") {
  run_body(run, R"(
%bare_a = OpAccessChain %bare_ptr %a %u0 %u7
%bare_b = OpAccessChain %bare_ptr %a %u0 %n
%d = OpPtrDiff %uint %bare_a %bare_b
%e = OpPtrDiff %uint %pa %pa
%r = OpISub %uint %d %e
)",
           "%bare_ptr = OpTypePointer StorageBuffer %uint\n", true);
}

CTS_CASE("pointers", "variable.compare_workgroup_with_null") {
  run_body(run, R"(
%first = OpAccessChain %shared_ptr %shared %u0
%same = OpIEqual %bool %n %u3
%p = OpSelect %shared_ptr %same %shared_null %first
%is_null = OpPtrEqual %bool %p %shared_null
%r = OpSelect %uint %is_null %x %n
)",
           "%shared_null = OpConstantNull %shared_ptr\n", true);
}

CTS_CASE("pointers", "variable.workgroup") {
  run_body(run, R"(
%own = OpAccessChain %shared_ptr %shared %n
OpStore %own %x
OpControlBarrier %u2 %u2 %u264
%across = OpBitwiseXor %uint %n %u7
%p0 = OpAccessChain %shared_ptr %shared %across
%p = OpSelect %shared_ptr %odd %own %p0
%v = OpLoad %uint %p
%r = OpIAdd %uint %v %n
)");
}

// ---- device addresses

constexpr char kReferences[] = R"(// target: vulkan1.1
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 64) in;
)";

Buffer addressed(Run& run, VkDeviceSize size) {
  run.require(run.gpu.extension_features.bufferDeviceAddress, "bufferDeviceAddress");
  return run.buffer(size, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
}

uint64_t address_of(Run& run, const Buffer& buffer) {
  VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  info.buffer = buffer.handle;
  return CTS_COMMAND(run.gpu, GetBufferDeviceAddressKHR)(run.device, &info);
}

/// Runs a shader whose push constants are `addresses`.
void run_addresses(Run& run, const std::string& code, const std::vector<uint64_t>& addresses,
                   const std::vector<Binding>& bindings) {
  const Resources res = run.resources(bindings, static_cast<uint32_t>(addresses.size() * 8));
  const VkPipeline pipeline =
      run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, std::string(kReferences) + code));
  run.dispatch(res, pipeline, 1, std::as_bytes(std::span(addresses)));
}

CTS_CASE("pointers", "address.linked_list") {
  struct Node {
    uint32_t value, pad;
    uint64_t next;
  };
  constexpr uint32_t kNodes = 100;
  const Buffer nodes = addressed(run, kNodes * sizeof(Node)), out = run.buffer(kInvocations * 4);
  const uint64_t base = address_of(run, nodes);
  for (uint32_t i = 0; i < kNodes; i++) {
    const uint32_t next = (i * 37 + 11) % kNodes;
    nodes.as<Node>()[i] = {run.random.bits(), 0, i % 9 == 0 ? 0 : base + next * sizeof(Node)};
  }
  run_addresses(run, R"(
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Node;
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Node { uint value; Node next; };
layout(push_constant) uniform P { Node first; } p;
layout(std430, binding = 0) buffer R { uint r[]; };
void main() {
  uint i = gl_GlobalInvocationID.x, s = 0u;
  Node at = p.first + int(i);
  for (int k = 0; k < 20; k++) {
    s = s * 31u + at.value;
    if (uvec2(at.next) == uvec2(0u)) break;
    at = at.next;
  }
  r[i] = s;
})",
                {base}, {storage_buffer(0, out)});
  run.out("out", out);
}

CTS_CASE("pointers", "address.stores_and_atomics") {
  const Buffer a = addressed(run, 4096), b = addressed(run, 4096);
  run_addresses(run, R"(
struct Item { vec3 v; uint n; mat2 m; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Items { Item items[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Counts { uint total; uint counts[8]; };
layout(push_constant) uniform P { Items items; Counts counts; } p;
void main() {
  uint i = gl_GlobalInvocationID.x;
  Item item;
  item.v = vec3(i, i * 2u, 0.5);
  item.n = atomicAdd(p.counts.counts[i & 7u], 1u) < 100u ? i : 0u;
  item.m = mat2(1.0, i, 3.0, 4.0);
  p.items.items[i] = item;
  atomicMax(p.counts.total, i * 5u);
  memoryBarrierBuffer();
  p.items.items[i].m[1].x = p.items.items[i].m[0].y * 2.0;
})",
                {address_of(run, a), address_of(run, b)}, {storage_buffer(0, run.buffer(4))});
  run.out("items", a);
  run.out("counts", b);
}

CTS_CASE("pointers", "address.chosen_per_invocation") {
  const Buffer a = addressed(run, 1024), b = addressed(run, 1024), out = run.buffer(kInvocations * 16);
  for (uint32_t i = 0; i < 256; i++) a.as<uint32_t>()[i] = run.random.bits(), b.as<uint32_t>()[i] = run.random.bits();
  run_addresses(run, R"(
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Words { uvec4 w[]; };
layout(push_constant) uniform P { Words a, b; } p;
layout(std430, binding = 0) buffer R { uvec4 r[]; };
Words pick(uint i, Words a, Words b) { return (i & 5u) == 1u ? a : b; }
void main() {
  uint i = gl_GlobalInvocationID.x;
  Words chosen = pick(i, p.a, p.b), other = p.a;
  if (i > 40u) other = chosen;
  r[i] = chosen.w[i] + other.w[63u - i].wzyx + Words(uvec2(p.b)).w[i / 3u];
})",
                {address_of(run, a), address_of(run, b)}, {storage_buffer(0, out)});
  run.out("out", out);
}

constexpr char kNarrow[] =
    "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
    "#extension GL_EXT_shader_8bit_storage : require\n"
    "#extension GL_EXT_shader_16bit_storage : require\n";

/// OpConvertPtrToU and OpConvertUToPtr.
CTS_CASE("pointers", "address.as_integer") {
  run.require(run.gpu.features.shaderInt64, "shaderInt64");
  const Buffer a = addressed(run, 1024), out = run.buffer(kInvocations * 4);
  for (uint32_t i = 0; i < 256; i++) a.as<uint32_t>()[i] = run.random.bits();
  run_addresses(run, R"(
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer Word { uint w; };
layout(push_constant) uniform P { Word first; } p;
layout(std430, binding = 0) buffer R { uint r[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint64_t address = uint64_t(p.first);
  r[i] = Word(address + uint64_t(i * 12u)).w + uint(address & 3ul);
})",
                {address_of(run, a)}, {storage_buffer(0, out)});
  run.out("out", out);
}

CTS_CASE("pointers", "address.narrow") {
  const auto& features = run.gpu.extension_features;
  run.require(features.storageBuffer8BitAccess && features.storageBuffer16BitAccess && features.shaderInt8 &&
                  features.shaderFloat16,
              "8- and 16-bit storage");
  const Buffer a = addressed(run, 4096), b = addressed(run, 4096);
  for (uint32_t i = 0; i < 1024; i++) a.as<uint32_t>()[i] = run.random.bits() & 0xbbffbbffu;
  run_addresses(run, std::string(kNarrow) + R"(
struct S { int8_t a; uint8_t b; int16_t c; float16_t h; u8vec3 v; f16vec3 w; uint8_t z[5]; uint u; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Items { S s[]; };
layout(buffer_reference, std430, buffer_reference_align = 1) buffer Bytes { uint8_t n[]; };
layout(buffer_reference, std430, buffer_reference_align = 2) buffer Halves { f16vec3 h[]; };
layout(push_constant) uniform P { Items from, to; Bytes bytes; Halves halves; } p;
void main() {
  uint i = gl_GlobalInvocationID.x;
  S s = p.from.s[i];
  s.v = s.v.zxy + u8vec3(s.b);
  s.w = s.w * float16_t(0.5) + p.halves.h[i / 3u];
  s.z[i % 5u] = p.bytes.n[i * 7u % 256u];
  s.c -= int16_t(s.a);
  if ((i & 3u) != 1u) p.to.s[i] = s;
  else p.to.s[i].v[i % 3u] = uint8_t(i);
})",
                {address_of(run, a), address_of(run, b), address_of(run, a), address_of(run, a) + 1024},
                {storage_buffer(0, run.buffer(4))});
  run.out("written", b, VK_FORMAT_R8_UINT);
}

CTS_CASE("pointers", "address.atomics_64") {
  run.require(run.gpu.features.shaderInt64 && run.gpu.extension_features.shaderBufferInt64Atomics, "64-bit atomics");
  const Buffer a = addressed(run, 1024), out = run.buffer(kInvocations * 8);
  for (uint32_t i = 0; i < 256; i++) a.as<uint32_t>()[i] = run.random.bits();
  run_addresses(run, R"(
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Counts { uint64_t u[64]; int64_t i[64]; };
layout(push_constant) uniform P { Counts c; } p;
layout(std430, binding = 0) buffer R { uint64_t r[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint64_t v = (uint64_t(i * 7u % 61u) << 32) - uint64_t(i * 0x10001u);
  atomicAdd(p.c.u[i & 3u], v);
  atomicMax(p.c.u[4u + (i & 3u)], v);
  atomicXor(p.c.u[8u + (i & 3u)], v);
  atomicMin(p.c.i[i & 3u], int64_t(v));
  r[i] = i >= 32u && atomicExchange(p.c.i[64u - 1u - i % 32u], int64_t(v)) != 0l ? 1ul : 0ul;
  r[i] += atomicCompSwap(p.c.u[12u + i % 32u], uint64_t(i), v) * (i < 32u ? 1ul : 0ul);
})",
                {address_of(run, a)}, {storage_buffer(0, out)});
  run.out("counts", a);
  run.out("old", out);
}

/// Atomics of binary16 behind a pointer and in a block of workgroup memory. The reference, which lacks them, does the
/// same one by one in a buffer.
CTS_CASE("pointers", "address.atomics_half") {
  const auto& features = run.gpu.extension_features;
  run.require(features.storageBuffer16BitAccess && features.shaderFloat16, "binary16 in buffers");
  const bool has = features.shaderBufferFloat16AtomicAdd && features.shaderBufferFloat16AtomicMinMax &&
                   features.shaderSharedFloat16AtomicAdd && features.workgroupMemoryExplicitLayout16BitAccess;
  const Buffer a = addressed(run, 1024), out = run.buffer(kInvocations * 4), scratch = run.buffer(1024);
  for (uint32_t i = 0; i < 512; i++) a.as<uint16_t>()[i] = static_cast<uint16_t>(0x4000 + 256 * (i & 3));
  const std::string text = std::string("// target: spirv1.4\n") +
                           (has ? "#extension GL_EXT_shader_atomic_float2 : require\n"
                                  "#extension GL_EXT_shared_memory_block : require\n"
                                  "#define ADD(at, v) atomicAdd(at, v)\n#define MAX(at, v) atomicMax(at, v)\n"
                                : "#define ADD(at, v) at += v\n#define MAX(at, v) at = max(at, v)\n") +
                           "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
                           "#extension GL_EXT_shader_16bit_storage : require\n" +
                           (has ? "shared" : "layout(std430, binding = 1) buffer") + R"( Block { float16_t s[8]; } b;
layout(buffer_reference, std430, buffer_reference_align = 2) buffer Halves { float16_t h[512]; };
layout(push_constant) uniform P { Halves c; } p;
layout(std430, binding = 0) buffer R { float16_t r[]; };
void act(uint i) {
  float16_t v = float16_t(int(i * 7u % 61u) - 30);
  ADD(p.c.h[1u + (i & 3u)], v);
  MAX(p.c.h[5u + (i & 3u)], v);
  ADD(p.c.h[9u], v);
  ADD(p.c.h[64u + i], v);
  ADD(b.s[i & 7u], v);
}
void main() {
  uint i = gl_LocalInvocationIndex;
  if (i < 8u) b.s[i] = float16_t(i);
  memoryBarrierBuffer();
  barrier();
)" + (has ? "  act(i);\n" : "  if (i == 0u) for (uint j = 0u; j < 64u; j++) act(j);\n") +
                           "  memoryBarrierBuffer();\n  barrier();\n  r[i] = b.s[i & 7u];\n}\n";
  run_addresses(run, text, {address_of(run, a)}, {storage_buffer(0, out), storage_buffer(1, scratch)});
  run.out("halves", a, VK_FORMAT_R16_SFLOAT);
  run.out("shared", out, VK_FORMAT_R16_SFLOAT);
}

/// Blocks in workgroup memory; the reference, which does not have them, is given a storage buffer of the same layout.
CTS_CASE("pointers", "workgroup_blocks") {
  const auto& features = run.gpu.extension_features;
  run.require(features.storageBuffer8BitAccess && features.storageBuffer16BitAccess && features.shaderInt8 &&
                  features.shaderFloat16,
              "8- and 16-bit storage");
  const bool blocks = features.workgroupMemoryExplicitLayout && features.workgroupMemoryExplicitLayout8BitAccess &&
                      features.workgroupMemoryExplicitLayout16BitAccess &&
                      features.workgroupMemoryExplicitLayoutScalarBlockLayout;
  std::vector<uint32_t> words(512);
  for (uint32_t& word : words) word = run.random.bits() & 0xbbffbbffu;
  const Buffer in = run.buffer_of(words), out = run.buffer(kInvocations * 16), scratch = run.buffer(8192);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out), storage_buffer(2, scratch)});
  const std::string first = blocks ? "layout(std430) shared" : "layout(std430, binding = 2) buffer";
  const VkPipeline pipeline = run.compute(
      res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                             "// target: spirv1.4\n" + std::string(kNarrow) +
                                 (blocks ? "#extension GL_EXT_shared_memory_block : require\n" : "") +
                                 "layout(local_size_x = 64) in;\n"
                                 "struct S { uint8_t a; f16vec2 h; mat3x2 m; uint u; uint8_t z[3]; };\n" +
                                 first + " A { S s[64]; } a;\n" + first + " B { uint w[64 * 12]; } b;\n" + R"(
layout(std430, binding = 0) buffer In { uint x[]; };
layout(std430, binding = 1) buffer Out { uvec4 r[]; };
void main() {
  uint i = gl_LocalInvocationIndex, k = i ^ 5u;
  S s;
  s.a = uint8_t(x[i]);
  s.h = unpackFloat2x16(x[i + 64u]);
  s.m = mat3x2(float(i), 1.0, 2.0, float(x[i] & 7u), 4.0, 5.0);
  s.u = x[i + 128u];
  s.z = uint8_t[3](uint8_t(i), uint8_t(2), uint8_t(x[i] >> 8));
  for (uint n = 0u; n < 12u; n++) b.w[i * 12u + n] = 0u;
  memoryBarrierBuffer();
  barrier();
  a.s[i] = s;
  memoryBarrierBuffer();
  barrier();
  S t = a.s[k];
  float f = t.m[i % 3u][k & 1u] + a.s[i].m[1].y;
  r[i] = uvec4(uint(t.a) + uint(t.z[i % 3u]) * 256u, packFloat2x16(t.h), floatBitsToUint(f), b.w[k * 12u + i % 12u]);
})"));
  run.dispatch(res, pipeline, 1);
  run.out("out", out);
}

CTS_CASE("pointers", "zeroed_workgroup") {
  run.require(run.gpu.extension_features.shaderZeroInitializeWorkgroupMemory, "shaderZeroInitializeWorkgroupMemory");
  const Buffer out = run.buffer(kInvocations * 4);
  const Resources res = run.resources({storage_buffer(0, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(// target: vulkan1.1
#extension GL_EXT_null_initializer : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer R { uint r[]; };
shared uint s[64] = {};
void main() {
  uint i = gl_LocalInvocationIndex;
  uint before = s[63u - i];
  barrier();
  s[i] = i + 5u;
  barrier();
  r[i] = before * 1000u + s[63u - i];
})"));
  run.dispatch(res, pipeline, 2);
  run.out("out", out);
}

}  // namespace
}  // namespace vitrine::cts
