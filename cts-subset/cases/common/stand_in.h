// Images of formats that the reference lacks: it gets one of the same values in a format that it has.
#pragma once

#include "harness/run.h"

namespace vitrine::cts {

/// Whether the reference has these features of a format, or its images can be given to it in another one.
bool has_or_stands_in(VkFormat format, VkFormatFeatureFlags features);
/// The format that images have on the reference: their own where it has the features.
VkFormat reference_format(VkFormat format, VkFormatFeatureFlags features);

/// An image of random texels, the same numbers on both devices. Where the reference lacks `features` of the format, its
/// image is a plain one of the values that the texels of the other decode to. Of depth and stencil: the depth.
Image random_or_stand_in(Run& run, const ImageSpec& spec, VkFormatFeatureFlags features);
/// The same with given texels of level 0.
Image image_or_stand_in(Run& run, const ImageSpec& spec, VkFormatFeatureFlags features,
                        const std::vector<unsigned char>& texels);

}  // namespace vitrine::cts
