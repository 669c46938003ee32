// Capabilities of modules (SPIR-V 3.31; Vulkan 1.3.239, Capabilities): what one that the device lacks allows would be
// refused instruction by instruction, or taken for something else.
#include "spirv/capabilities.h"

#include <spirv-tools/libspirv.h>
#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <iterator>

namespace vitrine::spirv {
namespace {

constexpr spv::Capability kSupported[] = {
#define VITRINE_CAPABILITY(name) spv::Capability::name,
#define VITRINE_NUMBERED_CAPABILITY(name, number) static_cast<spv::Capability>(number),
#include "spirv/capabilities.def"
#undef VITRINE_CAPABILITY
#undef VITRINE_NUMBERED_CAPABILITY
    // DXC declares it for every fetch from a multisampled image; the instructions that it allows are refused by name.
    spv::Capability::SparseResidency,
};

constexpr std::uint32_t kDeclaration = 2u << 16 | static_cast<std::uint32_t>(spv::Op::OpCapability);

std::string name_of(std::uint32_t capability) {
  const std::uint32_t module[] = {spv::MagicNumber, 0x10600, 0, 1, 0, kDeclaration, capability};
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  spv_text text = nullptr;
  spvBinaryToText(context, module, std::size(module), SPV_BINARY_TO_TEXT_OPTION_NO_HEADER, &text, nullptr);
  std::string name = std::to_string(capability);
  if (text != nullptr) {
    const std::string line(text->str, text->length);
    const std::size_t first = line.find(' ') + 1;
    name = line.substr(first, line.find('\n') - first);
  }
  spvTextDestroy(text);
  spvContextDestroy(context);
  return name;
}

}  // namespace

std::string missing_device_capability(std::span<const std::uint32_t> words) {
  // They come first in a module.
  for (std::size_t at = 5; at + 1 < words.size() && words[at] == kDeclaration; at += 2)
    if (std::none_of(std::begin(kSupported), std::end(kSupported),
                     [&](spv::Capability known) { return static_cast<std::uint32_t>(known) == words[at + 1]; }))
      return "capability " + name_of(words[at + 1]) + " is not supported";
  return {};
}

}  // namespace vitrine::spirv
