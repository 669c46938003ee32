// See amber.h. A buffer of the file is a BUFFER of the script, by its number; shaders go in as words.
#include "glass/bug/amber.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "glass/bug/amber_buffers.h"
#include "glass/bug/amber_draws.h"
#include "glass/bug/amber_images.h"
#include "glass/bug/contents.h"
#include "glass/bug/declared.h"
#include "glass/finding.h"

namespace vitrine::glass::bug {
namespace {

std::string amber_stage(VkShaderStageFlagBits stage) {
  std::string name(glass::stage_name(stage));
  if (name.empty()) throw Unspeakable{"such a stage"};
  std::ranges::replace(name, ' ', '_');
  return name;
}

/// A module as SPIRV-HEX: bytes. END follows the last one at once, since Amber waits for a number behind white space.
void write_module(std::ostream& out, const Bytes& words) {
  constexpr std::size_t kModuleBytesPerLine = 32;
  char text[4];
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::snprintf(text, sizeof text, "%02x", std::to_integer<unsigned>(words[i]));
    out << (i == 0 ? "" : i % kModuleBytesPerLine == 0 ? "\n" : " ") << text;
  }
  out << "END\n\n";
}

void write_shaders(std::ostream& out, const Bug& bug) {
  for (std::size_t i = 0; i < bug.stages.size(); ++i) {
    out << "SHADER " << amber_stage(bug.stages[i].stage) << " shader" << i << " SPIRV-HEX\n";
    write_module(out, *bug.stages[i].words);
  }
}

void write_images(std::ostream& out, const Bug& bug) {
  for (std::uint32_t i = 0; i < bug.images.size(); ++i) {
    if (!bug.images[i].name.empty()) out << "# " << bug.images[i].name << "\n";
    write_image(out, "image" + std::to_string(i), bug, i, false);
    if (!bug.lost) write_image(out, "expected_image" + std::to_string(i), bug, i, true);
  }
  for (std::size_t i = 0; i < bug.samplers.size(); ++i)
    write_sampler(out, "sampler" + std::to_string(i), bug.samplers[i].state);
}

const char* type_of(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      return "uniform";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "storage";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
      return "uniform_dynamic";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return "storage_dynamic";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "storage_image";
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return "sampled_image";
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
      return "combined_image_sampler";
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
      return "uniform_texel_buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return "storage_texel_buffer";
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return "";
    default:
      throw Unspeakable{"input attachments"};
  }
}

std::string plural(const char* noun, bool array) { return std::string(noun) + (array ? "_ARRAY" : ""); }

/// The names of one kind of object, and where in buffers descriptors begin and end.
struct Operands {
  std::string buffers, images, samplers, zeros, offsets, ranges;
};

Operands operands_of(const Bug& bug, const std::vector<Descriptor>& elements) {
  Operands out;
  for (const Descriptor& d : elements) {
    if (d.view != kNone) demand_plain(bug.views[d.view], bug.images[bug.views[d.view].image]);
    if (const std::string name = buffer_name(bug, d); !name.empty()) out.buffers.append(" ").append(name);
    if (d.view != kNone) out.images.append(" image").append(std::to_string(bug.views[d.view].image));
    if (d.sampler != kNone) out.samplers.append(" sampler").append(std::to_string(d.sampler));
    out.zeros.append(" 0");
    out.offsets.append(" ").append(std::to_string(d.offset));
    out.ranges.append(" ").append(std::to_string(d.range));
  }
  return out;
}

/// All elements of a binding up to the last one that there is. Those between them that nothing has written nobody may
/// read: they are as one of the others.
std::vector<Descriptor> elements_of(const Bug& bug, std::uint32_t set, const Binding& binding) {
  constexpr std::size_t kMost = 4096;
  std::vector<Descriptor> elements;
  std::vector<bool> there;
  const auto at = [&](std::size_t element) -> Descriptor& {
    if (element >= kMost) throw Unspeakable{"arrays of so many descriptors"};
    if (element >= elements.size()) elements.resize(element + 1), there.resize(element + 1);
    there[element] = true;
    return elements[element];
  };
  for (const Descriptor& d : bug.descriptors)
    if (d.set == set && d.binding == binding.binding) at(d.element) = d;
  // Immutable samplers are bound like others.
  for (std::size_t i = 0; i < binding.samplers.size(); ++i)
    if (binding.type == VK_DESCRIPTOR_TYPE_SAMPLER || (i < there.size() && there[i]))
      at(i).sampler = binding.samplers[i];
  if (std::ranges::any_of(elements, &Descriptor::gone)) throw Unspeakable{"descriptors of what was destroyed"};
  const auto first = std::ranges::find(there, true) - there.begin();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (there[i]) continue;
    if (bug.null_descriptors) throw Unspeakable{"null descriptors"};
    elements[i] = elements[static_cast<std::size_t>(first)];
  }
  return elements;
}

/// Of combined image samplers, the sampler of all elements: the language has one for a binding.
std::uint32_t sampler_of(const std::vector<Descriptor>& elements) {
  const std::uint32_t sampler = elements[0].sampler;
  if (std::ranges::any_of(elements, [&](const Descriptor& d) { return d.sampler != sampler; }))
    throw Unspeakable{"arrays of images with several samplers"};
  return sampler;
}

/// All elements of a binding in one line. Layouts of pipelines are made of what is bound.
void write_binding(std::ostream& out, const Bug& bug, std::uint32_t set, const Binding& binding) {
  const std::vector<Descriptor> elements = elements_of(bug, set, binding);
  if (elements.empty()) {
    if (declared_in(bug).contains({set, binding.binding})) throw Unspeakable{"descriptors that nothing has written"};
    return;
  }
  const VkDescriptorType kind = plain_type(bug, set, binding);
  if (kind == VK_DESCRIPTOR_TYPE_MUTABLE_EXT) throw Unspeakable{"arrays of descriptors of several types"};
  const bool array = elements.size() > 1, sampler = kind == VK_DESCRIPTOR_TYPE_SAMPLER;
  const Operands names = operands_of(bug, elements);
  out << "  BIND "
      << (sampler ? plural("SAMPLER", array) + names.samplers : plural("BUFFER", array) + names.buffers + names.images);
  if (const char* const type = type_of(kind); *type) out << " AS " << type;
  if (kind == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) out << " SAMPLER sampler" << sampler_of(elements);
  out << " DESCRIPTOR_SET " << set << " BINDING " << binding.binding;
  if (is_dynamic(kind)) out << " OFFSET" << names.zeros;
  if (kind_of(kind) == ResourceKind::kBuffer)
    out << " DESCRIPTOR_OFFSET" << names.offsets << " DESCRIPTOR_RANGE" << names.ranges;
  out << "\n";
}

/// SPECIALIZE takes 32 bits; the type does not matter to the bits of words.
void write_constants(std::ostream& out, const Stage& stage) {
  for (const VkSpecializationMapEntry& entry : stage.constants) {
    if (entry.size != 4) throw Unspeakable{"specialization constants of other sizes than 32 bits"};
    std::uint32_t value = 0;
    std::memcpy(&value, stage.constant_data->data() + entry.offset, 4);
    out << " SPECIALIZE " << entry.constantID << " AS uint32 " << value;
  }
}

void write_stage(std::ostream& out, const Stage& stage, std::size_t number) {
  out << "  ATTACH shader" << number;
  if (!stage.constants.empty() || stage.entry_point != "main")
    out << " TYPE " << amber_stage(stage.stage) << " ENTRY_POINT " << stage.entry_point;
  write_constants(out, stage);
  out << "\n";
  if (stage.subgroup_size)
    out << "  SUBGROUP shader" << number << "\n    FULLY_POPULATED off\n    VARYING_SIZE off\n    REQUIRED_SIZE "
        << stage.subgroup_size << "\n  END\n";
}

/// `run`: of draws, which of them.
void write_pipeline(std::ostream& out, const Bug& bug, std::size_t run) {
  out << "PIPELINE " << (bug.dispatches() ? "compute" : "graphics") << " " << pipeline_name(run) << "\n";
  for (std::size_t i = 0; i < bug.stages.size(); ++i) write_stage(out, bug.stages[i], i);
  if (!bug.dispatches()) write_state_of_draw(out, bug, run);
  for (std::uint32_t set = 0; set < bug.sets.size(); ++set)
    for (const Binding& binding : bug.sets[set].bindings) write_binding(out, bug, set, binding);
  if (bug.push_constants && !bug.push_constants->empty()) out << "  BIND BUFFER pushed AS push_constant\n";
  out << "END\n\n";
}

void write_dispatch(std::ostream& out, const Bug& bug) {
  std::array<std::uint32_t, 3> groups = bug.command.groups;
  if (bug.command.arguments != kNone) {
    const Bytes bytes = contents_of(bug, bug.buffers[bug.command.arguments], false);
    const std::uint64_t at = bug.command.arguments_offset;
    if (at > bytes.size() || bytes.size() - at < sizeof groups) throw Unspeakable{"arguments outside of their buffer"};
    std::memcpy(groups.data(), bytes.data() + at, sizeof groups);
  }
  if (std::any_of(bug.command.base.begin(), bug.command.base.end(), [](std::uint32_t b) { return b != 0; }))
    throw Unspeakable{"dispatches that do not begin with workgroup 0"};
  out << "RUN pipeline " << groups[0] << " " << groups[1] << " " << groups[2] << "\n\n";
}

void write_expectations(std::ostream& out, const Bug& bug) {
  if (bug.lost) return;
  write_expectations_of_buffers(out, bug);
  for (std::size_t i = 0; i < bug.images.size(); ++i)
    out << "EXPECT image" << i << " EQ_BUFFER expected_image" << i << "\n";
}

void write_head(std::ostream& out, const Bug& bug) {
  out << "#!amber\n# Captured by Vitrine: " << bug.command_name << ", submission " << bug.submission << ", command "
      << bug.command_number << ".\n";
  for (const Found& found : bug.findings) {
    std::string line = found.rule + ": " + found.message + (found.place.empty() ? "" : ", at " + found.place);
    std::replace(line.begin(), line.end(), '\n', ' ');
    out << "# " << line << "\n";
  }
  if (std::ranges::any_of(bug.stages, [](const Stage& s) { return s.subgroup_size != 0; }))
    out << "DEVICE_FEATURE SubgroupSizeControl.subgroupSizeControl\n"
           "DEVICE_FEATURE SubgroupSizeControl.computeFullSubgroups\nDEVICE_EXTENSION VK_EXT_subgroup_size_control\n";
  if (!bug.dispatches()) write_features_of_draw(out, bug);
  out << "\n";
}

}  // namespace

base::Result<std::string> to_amber(const Bug& bug) {
  std::ostringstream out;
  try {
    write_head(out, bug);
    write_shaders(out, bug);
    write_buffers(out, bug);
    write_images(out, bug);
    if (!bug.dispatches()) write_buffers_of_draw(out, bug);
    const std::size_t pipelines = bug.dispatches() ? 1 : pipelines_of_draw(bug);
    for (std::size_t run = 0; run < pipelines; ++run) write_pipeline(out, bug, run);
    bug.dispatches() ? write_dispatch(out, bug) : write_draws(out, bug);
    write_expectations(out, bug);
  } catch (const Unspeakable& word) {
    return base::Error{"AmberScript is not written for " + word.what};
  }
  return out.str();
}

}  // namespace vitrine::glass::bug
