// The narrow interface between fixed function and shaders: whole waves in, whole waves out. raster/ includes only this
// header of spirv/ (and stage_memory.h, resources.h); it never sees SPIR-V ids.
//
// Use: compile() once per pipeline stage -> Shader. Per draw: bind() runs the uniform preamble -> BoundShader, shared
// by all threads. Per thread: a WaveRunner holds the memory of one wave; fill its inputs, run(), read its outputs.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/lanes.h"
#include "spirv/resources.h"

namespace vitrine::spirv {

struct Program;     // spirv/program.h
struct SourceInfo;  // spirv/source_info.h

enum class BaseType : std::uint8_t { kFloat, kInt, kUint };
enum class Interpolation : std::uint8_t { kPerspective, kLinear, kFlat };
enum class SampleLocation : std::uint8_t { kCenter, kCentroid, kSample };
/// What a slot of an interpolated component holds: its value at the slot's SampleLocation, or a coefficient of its
/// plane (raster's planes: value at the framebuffer's origin, change per pixel to the right, change per pixel down), or
/// what a vertex of the primitive has (PerVertexKHR).
enum class InputPart : std::uint8_t { kValue, kPlaneOrigin, kPlaneX, kPlaneY, kVertex0, kVertex1, kVertex2 };
inline bool is_of_vertex(InputPart part) { return part >= InputPart::kVertex0; }

/// Values fixed function supplies or takes, besides the numbered locations. Booleans are 0 / 0xffffffff.
enum class BuiltIn : std::uint8_t {
  kNone,
  // vertex in
  kVertexIndex,
  kInstanceIndex,
  kBaseVertex,
  kBaseInstance,
  kDrawIndex,
  kViewIndex,
  // tessellation and geometry in (kPrimitiveId, kViewIndex too)
  kInvocationId,
  kPatchVertices,
  kTessCoord,
  kVertexTable,  ///< byte offset in stage memory of the invocation's row of vertex offsets
  kPatchOffset,  ///< byte offset in stage memory of the patch: read by evaluation, written by control shaders
  kEmitOffset,   ///< byte offset in stage memory of the vertices that the invocation emits
  kIdentity,     ///< of observed programs: which invocation it is, three numbers (spirv/exec/invocation.h)
  // tessellation control out, evaluation in: words of the patch
  kTessLevelOuter,
  kTessLevelInner,
  // geometry out: how many vertices were emitted
  kEmittedVertices,
  // vertex out
  kPosition,
  kPointSize,
  kClipDistance,
  kCullDistance,
  kLayer,
  kViewportIndex,
  kPrimitiveShadingRate,
  // fragment in (kLayer, kViewportIndex, kClipDistance, kCullDistance, kViewIndex too)
  kFragCoord,
  kFrontFacing,
  kPointCoord,
  kBaryCoord,
  kBaryCoordNoPersp,
  kSampleId,
  kSamplePosition,
  kSampleMask,
  kPrimitiveId,
  kHelperInvocation,
  kShadingRate,  ///< as raster::FragmentRate
  // fragment in, for interpolateAt*: where planes are evaluated, in pixels
  kInterpolationCenter,  ///< x, y at the pixel's centre
  kInterpolationSample,  ///< component 2 s: x at sample s, 2 s + 1: y
  kInterpolationScale,   ///< factor of perspective planes: 1 / (1/w) at the centre
  // fragment out (kSampleMask too)
  kFragDepth,
  kFragStencilRef,
};

inline constexpr std::uint8_t kNoXfbBuffer = 255;
inline constexpr std::uint32_t kMaxXfbBuffers = 4;

/// One scalar 32-bit component of the interface. `component` counts 0..3 in a location, or the element of a built-in
/// (FragCoord.z = 2, ClipDistance[5] = 5).
struct InterfaceSlot {
  BuiltIn built_in = BuiltIn::kNone;
  std::uint8_t component = 0;
  std::uint16_t location = 0;
  std::uint8_t index = 0;  ///< dual source blending: Index decoration
  BaseType type = BaseType::kFloat;
  std::uint8_t stream = 0;                 ///< geometry out
  std::uint8_t xfb_buffer = kNoXfbBuffer;  ///< last stage before rasterization: captured there
  std::uint32_t xfb_offset = 0;            ///< bytes in the buffer's stride
  Interpolation interpolation = Interpolation::kPerspective;
  SampleLocation sample_location = SampleLocation::kCenter;
  InputPart part = InputPart::kValue;
  bool implied = false;   ///< not the shader reads it, but this device: layers of input attachments, for observers
  std::uint32_t reg = 0;  ///< register of the wave: WaveRunner::input(reg) / output(reg)
};

enum class TessDomain : std::uint8_t { kTriangles, kQuads, kIsolines };
enum class TessSpacing : std::uint8_t { kEqual, kFractionalOdd, kFractionalEven };

/// Execution modes of tessellation and geometry stages, and what they keep in stage memory (spirv/stage_memory.h).
struct StageModes {
  // geometry
  std::uint32_t input_vertices = 0;  ///< of a primitive: 1, 2, 3, 4 (lines with adjacency) or 6 (triangles with)
  VkPrimitiveTopology output = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;  ///< or LINE_STRIP, TRIANGLE_STRIP
  std::uint32_t max_vertices = 0, invocations = 1;
  // tessellation; those of both stages together hold
  std::uint32_t control_points = 0;  ///< vertices of an output patch
  bool has_domain = false, has_spacing = false, has_order = false;
  TessDomain domain = TessDomain::kTriangles;
  TessSpacing spacing = TessSpacing::kEqual;
  bool clockwise = false, point_mode = false;
  // stage memory
  std::uint32_t input_locations = 0;  ///< of an input vertex, locations that may be read
  std::uint32_t vertex_words = 0;     ///< of an output vertex: control shaders, geometry shaders
  std::uint32_t patch_words = 0;      ///< control shaders: in front of the vertices
};

/// Which invocations of a workgroup are a quad, for derivatives: execution modes DerivativeGroup*.
enum class DerivativeGroup : std::uint8_t {
  kNone,
  kLinear,  ///< four with indices one behind the other
  kQuads,   ///< those of two columns in two rows
};

struct ShaderInterface {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
  std::vector<InterfaceSlot> inputs;   ///< only those the shader reads
  std::vector<InterfaceSlot> outputs;  ///< only those it may write
  std::vector<InterfaceSlot> emitted;  ///< geometry: what each vertex holds; `reg` is a word of the vertex
  StageModes modes;
  bool captures = false;                          ///< execution mode Xfb
  std::uint32_t xfb_stride[kMaxXfbBuffers] = {};  ///< bytes
  std::uint32_t local_size[3] = {1, 1, 1};
  DerivativeGroup derivative_group = DerivativeGroup::kNone;  ///< compute
  std::uint32_t shared_bytes = 0;
  std::uint32_t push_bytes = 0;                             ///< where the block of push constants ends
  std::vector<std::array<std::uint32_t, 2>> zeroed_shared;  ///< byte ranges [first, end) of it that shaders rely on

  bool uses_discard = false;          ///< may end fragments (kill, terminate, demote)
  bool writes_memory = false;         ///< stores or atomics to buffers or images
  bool reads_attachment = false;      ///< loads from input attachments
  bool early_fragment_tests = false;  ///< execution mode
  bool post_depth_coverage = false;   ///< execution mode: SampleMask as an input counts what passed the early tests
  bool per_sample = false;            ///< declares SampleId, SamplePosition or a `sample` input, read or not
  bool needs_helpers = false;         ///< derivatives or implicit LOD: quads must be complete
  bool writes_depth() const { return writes(BuiltIn::kFragDepth); }
  bool writes(BuiltIn built_in) const {
    for (const InterfaceSlot& slot : outputs)
      if (slot.built_in == built_in) return true;
    return false;
  }
};

/// An executable entry point. Immutable; shared by any number of threads.
class Shader {
 public:
  Shader(ShaderInterface interface, std::unique_ptr<const Program> program);
  ~Shader();
  const ShaderInterface& interface() const { return interface_; }
  const Program& program() const { return *program_; }

 private:
  ShaderInterface interface_;
  std::unique_ptr<const Program> program_;
};

/// What went wrong while a shader ran: its instruction budget is spent. Set by any thread; of several workgroups of a
/// dispatch the first in order counts.
struct Fault {
  std::atomic<bool> raised{false};
  std::atomic<std::uint64_t> order{~std::uint64_t{0}};  ///< of the workgroup
  // Valid once `raised` is true and all threads are done.
  std::string message;  ///< names the source line
  std::shared_ptr<const SourceInfo> sources;
  std::uint32_t place = 0;     ///< of the loop; SourceInfo::places
  std::uint32_t spirv_id = 0;  ///< 0: unknown
};

/// A shader with its resources and the results of its uniform preamble. Built once per draw or dispatch, then constant.
class BoundShader {
 public:
  /// Runs the preamble on the calling thread, in the floating-point mode of the shader's stage. `fault` outlives this.
  BoundShader(const Shader& shader, const ResourceTable& resources, Fault& fault);
  ~BoundShader();
  BoundShader(BoundShader&&) noexcept;
  const Shader& shader() const { return *shader_; }
  const ResourceTable& resources() const { return resources_; }
  const std::uint32_t* uniforms() const { return uniforms_; }
  Fault& fault() const { return *fault_; }

 private:
  const Shader* shader_;
  ResourceTable resources_;
  Fault* fault_;
  std::unique_ptr<std::byte[]> storage_;  ///< of uniforms_, with room to align it: faster than aligned memory
  std::uint32_t* uniforms_;               ///< uniform file: constants, then preamble results; 64-byte aligned
};

/// The memory of one wave. One per thread; reusable for any shader: bind() grows it when needed (the only allocation).
class WaveRunner {
 public:
  WaveRunner();
  ~WaveRunner();
  WaveRunner(const WaveRunner&) = delete;
  WaveRunner& operator=(const WaveRunner&) = delete;

  void bind(const BoundShader& shader);

  /// Memory that tessellation and geometry stages share with fixed function: words, until the next bind().
  void set_stage_memory(std::uint32_t* words, std::size_t count);

  /// Registers of InterfaceSlot::reg. Inputs must be written for every lane in `active` before each run() (run() may
  /// reuse input registers for other values); outputs are valid after run() until the next.
  base::WaveRegister& input(std::uint32_t reg);
  const base::WaveRegister& output(std::uint32_t reg) const;

  /// Whether the bound shader computes nothing and output `reg` is the same in all lanes: valid without a run().
  bool is_constant(std::uint32_t reg) const;

  /// Runs the entry point for the lanes of `active`. `helpers` (a subset of `active`) execute for derivatives only:
  /// their stores and atomics have no effect. Returns the lanes of active & ~helpers that were not discarded.
  base::LaneMask run(base::LaneMask active, base::LaneMask helpers);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Runs a compute shader over group counts `groups` starting at `base`, spread over the workers. Returns when done;
/// denormals are honoured. Faults are reported through the BoundShader's Fault.
void dispatch(const BoundShader& shader, const std::uint32_t base[3], const std::uint32_t groups[3]);

}  // namespace vitrine::spirv
