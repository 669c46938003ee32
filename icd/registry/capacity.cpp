// What the device claims (manifest/limits) fits into what the rooms below have room for: arrays of fixed size. A claim
// that outgrows one of them does not compile.
#include "icd/properties.h"
#include "raster/draw.h"
#include "raster/pixel_order.h"
#include "raster/plan.h"
#include "raster/sample_locations.h"
#include "spirv/resources.h"
#include "spirv/shader.h"
#include "texel/view.h"

namespace vitrine::icd {
namespace {

constexpr const VkPhysicalDeviceLimits& kLimits = kClaimedPhysicalDeviceProperties.limits;
constexpr const VkPhysicalDeviceTransformFeedbackPropertiesEXT& kXfb =
    kClaimedPhysicalDeviceTransformFeedbackPropertiesEXT;
constexpr const VkPhysicalDeviceFragmentShadingRatePropertiesKHR& kRates =
    kClaimedPhysicalDeviceFragmentShadingRatePropertiesKHR;

static_assert(kLimits.maxVertexInputBindings <= raster::kMaxVertexBindings);
static_assert(kLimits.maxVertexInputAttributes <= raster::kMaxVertexAttributes);
static_assert(kLimits.maxTessellationPatchSize <= raster::kMaxPatchVertices);
static_assert(kLimits.maxVertexOutputComponents <= raster::kMaxVaryings);
static_assert(kLimits.maxFragmentInputComponents <= raster::kMaxVaryings);
static_assert(kLimits.maxCombinedClipAndCullDistances <= raster::kMaxClipDistances);
static_assert(kLimits.maxViewports <= raster::kMaxViewports);
static_assert(kLimits.maxColorAttachments <= raster::kMaxColorAttachments);
static_assert(kLimits.framebufferColorSampleCounts < 2 * raster::kMaxSamples);
static_assert(kRates.maxFragmentSize.width <= raster::kLargestFragment);
static_assert(kRates.maxFragmentSize.height <= raster::kLargestFragment);
static_assert(kRates.maxFragmentShadingRateCoverageSamples <= raster::kMaxFragmentSamples);
static_assert(kRates.minFragmentShadingRateAttachmentTexelSize.width >= raster::kBlockSize);
static_assert(kRates.minFragmentShadingRateAttachmentTexelSize.height >= raster::kBlockSize);
static_assert(kLimits.maxBoundDescriptorSets <= spirv::kMaxSets);
static_assert(kLimits.maxPushConstantsSize <= spirv::kMaxPushConstantBytes);
static_assert(kLimits.maxImageDimension2D < 1u << texel::kMaxLevels);
static_assert(kLimits.maxImageDimensionCube < 1u << texel::kMaxLevels);
static_assert(kXfb.maxTransformFeedbackStreams <= raster::kMaxStreams);
static_assert(kXfb.maxTransformFeedbackBuffers <= spirv::kMaxXfbBuffers);

}  // namespace
}  // namespace vitrine::icd
