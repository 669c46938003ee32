// Samplers and Y'CbCr conversions (Vulkan 1.3.239, Samplers).
#include <cstring>

#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/address_book.h"
#include "icd/object/descriptor_bytes.h"
#include "icd/object/image.h"
#include "texel/sampler/plan.h"
#include "texel/swizzle.h"

namespace vitrine::icd {
namespace {

constexpr std::uint32_t kOneF = 0x3f800000;

std::array<std::uint32_t, 4> border_bits(VkBorderColor color) {
  switch (color) {
    case VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK:
      return {0, 0, 0, kOneF};
    case VK_BORDER_COLOR_INT_OPAQUE_BLACK:
      return {0, 0, 0, 1};
    case VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE:
      return {kOneF, kOneF, kOneF, kOneF};
    case VK_BORDER_COLOR_INT_OPAQUE_WHITE:
      return {1, 1, 1, 1};
    default:
      return {0, 0, 0, 0};
  }
}

bool is_custom(VkBorderColor color) {
  return color == VK_BORDER_COLOR_FLOAT_CUSTOM_EXT || color == VK_BORDER_COLOR_INT_CUSTOM_EXT;
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateSampler(VkDevice device, const VkSamplerCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkSampler* sampler) {
  Sampler* object = create_object<Sampler>(from_handle<Device>(device).memory, allocator);
  texel::Sampler& state = object->state;
  state.mag_filter = info->magFilter;
  state.min_filter = info->minFilter;
  state.mip_mode = info->mipmapMode;
  state.address = {info->addressModeU, info->addressModeV, info->addressModeW};
  state.seams = (info->flags & VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT) != 0;
  state.mip_lod_bias = info->mipLodBias;
  state.min_lod = info->minLod;
  state.max_lod = info->maxLod;
  state.max_anisotropy = info->anisotropyEnable ? info->maxAnisotropy : 1.0f;
  state.compare = info->compareEnable;
  state.compare_op = info->compareOp;
  state.border = border_bits(info->borderColor);
  state.custom_border = is_custom(info->borderColor);
  if (state.custom_border) {
    if (const auto* custom = find_in_chain<VkSamplerCustomBorderColorCreateInfoEXT>(info->pNext)) {
      std::memcpy(state.border.data(), &custom->customBorderColor, sizeof(state.border));
    }
  }
  state.unnormalized = info->unnormalizedCoordinates;
  if (const auto* reduction = find_in_chain<VkSamplerReductionModeCreateInfo>(info->pNext)) {
    state.reduction = reduction->reductionMode;
  }
  if (const auto* conversion = find_in_chain<VkSamplerYcbcrConversionInfo>(info->pNext)) {
    state.conversion = from_handle<SamplerYcbcrConversion>(conversion->conversion).state;
  }
  enter_address(from_handle<Device>(device), {&state, sizeof state, nullptr, {}}, *object);
  *sampler = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroySampler(VkDevice device, VkSampler sampler, const VkAllocationCallbacks*) {
  const Device& d = from_handle<Device>(device);
  leave_address(d, from_nullable<Sampler>(sampler));
  if (d.described && sampler) d.described->samplers.forget(from_handle<Sampler>(sampler));
  destroy_handle<Sampler>(sampler);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateSamplerYcbcrConversion(VkDevice device,
                                                            const VkSamplerYcbcrConversionCreateInfo* info,
                                                            const VkAllocationCallbacks* allocator,
                                                            VkSamplerYcbcrConversion* conversion) {
  auto* object = create_object<SamplerYcbcrConversion>(from_handle<Device>(device).memory, allocator);
  texel::YcbcrConversion& state = object->state;
  state.enabled = true;
  state.model = info->ycbcrModel;
  state.range = info->ycbcrRange;
  state.swizzle = texel::resolve_swizzle(info->components);
  state.x_cosited = info->xChromaOffset == VK_CHROMA_LOCATION_COSITED_EVEN;
  state.y_cosited = info->yChromaOffset == VK_CHROMA_LOCATION_COSITED_EVEN;
  state.chroma_filter = info->chromaFilter;
  *conversion = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroySamplerYcbcrConversion(VkDevice, VkSamplerYcbcrConversion conversion,
                                                         const VkAllocationCallbacks*) {
  destroy_handle<SamplerYcbcrConversion>(conversion);
}

}  // namespace entry
}  // namespace vitrine::icd
