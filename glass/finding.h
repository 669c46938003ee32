// What a tool has found, and where: one address for everything that happens inside the device (glass.md 2 step 4).
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vitrine::glass {

enum class Severity : std::uint8_t { kNote, kWarning, kError };

/// Row of rules.def: a kind of finding. Ids are stable: reports and suppressions name them.
struct Rule {
  const char* id;  ///< "out-of-bounds-store"
  Severity severity;
  const char* title;  ///< one line
  const char* help;   ///< what it means and what to do about it, with the source of the rule
};

/// A place in the source; lines and columns count from 1, 0: unknown.
struct Frame {
  std::string function, file;
  std::uint32_t line = 0, column = 0;
  std::string text;  ///< of the line; empty: unknown
};

/// One invocation of a shader, in numbers that the application knows.
struct Invocation {
  enum class Kind : std::uint8_t {
    kNone,
    kVertex,      ///< VertexIndex, InstanceIndex
    kFragment,    ///< x, y of the pixel
    kCompute,     ///< GlobalInvocationId
    kControl,     ///< InvocationId, PrimitiveId of the patch, instance of the draw
    kEvaluation,  ///< number of the domain point in its patch, PrimitiveId of the patch, instance of the draw
    kGeometry,    ///< InvocationId (behind tessellation: over all primitives of a patch), primitive or patch, instance
  } kind = Kind::kNone;
  std::array<std::uint32_t, 3> id{};
  auto operator<=>(const Invocation&) const = default;
};

/// Everything that is known of where something happened, from the outside in. Empty and 0: unknown.
struct Address {
  std::uint64_t submission = 0;     ///< counted from 1
  std::uint32_t command = 0;        ///< in the submission, counted from 1
  std::string command_name;         ///< "vkCmdDraw"
  std::vector<std::string> labels;  ///< open debug labels, outermost first
  std::string pipeline, shader;     ///< names that the application gave; the shader's else "main"...
  VkShaderStageFlagBits stage{};
  Invocation invocation;
  std::uint32_t spirv_id = 0;
  std::vector<Frame> frames;  ///< innermost first, then the calls that lead there
};

/// Another access that a finding is about.
struct RelatedAccess {
  std::string message;  ///< "store of 4 bytes"
  Address address;
};

struct Finding {
  const Rule* rule = nullptr;
  std::string message;                 ///< what was accessed, what is there
  Address address;                     ///< of the first invocation in order
  std::uint64_t count = 1;             ///< invocations (times lanes come by) at this place
  std::vector<RelatedAccess> related;  ///< races: the access before
  std::string remedy;                  ///< code that repairs it; empty: the rule's help says all
};

/// "submission 1, command 3 (vkCmdDispatch) in 'blur' > 'horizontal', pipeline 'gauss', compute shader main, invocation
/// (5, 0, 0)": as far as it is known.
std::string to_text(const Address& address);
/// "invocation (5, 0, 0)", "pixel (3, 7)", "vertex 3 of instance 0"; empty: none.
std::string to_text(const Invocation& invocation);
/// "file:line:column" as far as it is known.
std::string to_text(const Frame& frame);
/// "compute", "fragment"...; empty: none.
std::string_view stage_name(VkShaderStageFlagBits stage);
/// "error", "warning", "note".
std::string_view severity_name(Severity severity);

/// All rules (rules.def), in its order.
std::span<const Rule> rules();
/// The rule with this id, which must exist.
const Rule& rule(std::string_view id);

}  // namespace vitrine::glass
