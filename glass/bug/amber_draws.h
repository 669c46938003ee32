// Draws in AmberScript.
#pragma once

#include <ostream>

#include "glass/bug/amber_images.h"

namespace vitrine::glass::bug {

/// DEVICE_FEATURE lines of what its stages and state need.
void write_features_of_draw(std::ostream& out, const Bug& bug);
/// Buffers that the script alone has: indices from where they begin, vertices of draws that read none.
void write_buffers_of_draw(std::ostream& out, const Bug& bug);
/// Attachments, vertices and state: lines of PIPELINE. Throws Unspeakable for state that there are no words for.
void write_state_of_draw(std::ostream& out, const Bug& bug);
/// RUN.
void write_draw(std::ostream& out, const Bug& bug);

}  // namespace vitrine::glass::bug
