// Draws in AmberScript.
#pragma once

#include <ostream>

#include "glass/bug/amber_images.h"

namespace vitrine::glass::bug {

/// DEVICE_FEATURE lines of what its stages and state need.
void write_features_of_draw(std::ostream& out, const Bug& bug);
/// Several indexed draws have a pipeline each: indices are its.
std::size_t pipelines_of_draw(const Bug& bug);
std::string pipeline_name(std::size_t run);
/// Buffers that the script alone has: indices from where they begin, vertices of draws that read none.
void write_buffers_of_draw(std::ostream& out, const Bug& bug);
/// Attachments, vertices and state: lines of PIPELINE. Throws Unspeakable for state that there are no words for.
void write_state_of_draw(std::ostream& out, const Bug& bug, std::size_t run);
/// RUN, for each of the draws.
void write_draws(std::ostream& out, const Bug& bug);

}  // namespace vitrine::glass::bug
