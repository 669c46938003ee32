// See amber.h. A buffer of the file is a BUFFER of the script, by its number; shaders go in as words.
#include "glass/bug/amber.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "glass/bug/amber_draws.h"
#include "glass/bug/amber_images.h"
#include "glass/bug/contents.h"
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

/// BUFFER with its data, of words where that goes.
void write_buffer(std::ostream& out, const std::string& name, const Bytes& bytes) {
  write_numbers(out, name, bytes, bytes.size() % 4 == 0 ? 4 : 1);
}

bool overlaps(const Bug& bug, std::size_t number) {
  const Buffer& a = bug.buffers[number];
  for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
    const Buffer& b = bug.buffers[i];
    if (i != number && a.memory == b.memory && a.offset < b.offset + b.size && b.offset < a.offset + a.size)
      return true;
  }
  return false;
}

void write_buffers(std::ostream& out, const Bug& bug) {
  if (!bug.addressed.empty()) throw Unspeakable{"shaders that follow device addresses"};
  for (std::size_t i = 0; i < bug.buffers.size(); ++i) {
    if (overlaps(bug, i)) throw Unspeakable{"buffers that overlap"};
    if (!bug.buffers[i].name.empty()) out << "# " << bug.buffers[i].name << "\n";
    write_buffer(out, "buffer" + std::to_string(i), contents_of(bug, bug.buffers[i], false));
    if (!bug.lost) write_buffer(out, "expected" + std::to_string(i), contents_of(bug, bug.buffers[i], true));
  }
  if (bug.push_constants && !bug.push_constants->empty()) write_buffer(out, "pushed", *bug.push_constants);
  out << "\n";
}

void write_images(std::ostream& out, const Bug& bug) {
  for (std::size_t i = 0; i < bug.images.size(); ++i) {
    if (!bug.images[i].name.empty()) out << "# " << bug.images[i].name << "\n";
    write_image(out, "image" + std::to_string(i), bug.images[i], false);
    if (!bug.lost) write_image(out, "expected_image" + std::to_string(i), bug.images[i], true);
  }
  for (std::size_t i = 0; i < bug.samplers.size(); ++i)
    write_sampler(out, "sampler" + std::to_string(i), bug.samplers[i].state);
}

const char* type_of(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
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
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return "";
    default:
      throw Unspeakable{"inline uniform blocks and texel buffers"};
  }
}

bool is_dynamic(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
}

std::string plural(const char* noun, bool array) { return std::string(noun) + (array ? "_ARRAY" : ""); }

/// The names of one kind of object, and where in buffers descriptors begin and end.
struct Operands {
  std::string buffers, images, samplers, zeros, offsets, ranges;
};

Operands operands_of(const Bug& bug, const std::vector<const Descriptor*>& elements) {
  Operands out;
  for (const Descriptor* d : elements) {
    if (d->view != kNone) demand_whole(bug.views[d->view], bug.images[bug.views[d->view].image]);
    if (d->buffer != kNone) out.buffers.append(" buffer").append(std::to_string(d->buffer));
    if (d->view != kNone) out.images.append(" image").append(std::to_string(bug.views[d->view].image));
    if (d->sampler != kNone) out.samplers.append(" sampler").append(std::to_string(d->sampler));
    out.zeros.append(" 0");
    out.offsets.append(" ").append(std::to_string(d->offset));
    out.ranges.append(" ").append(std::to_string(d->range));
  }
  return out;
}

/// All elements of a binding in one line: they must all be there.
void write_binding(std::ostream& out, const Bug& bug, std::uint32_t set, const Binding& binding) {
  std::vector<const Descriptor*> elements;
  for (const Descriptor& d : bug.descriptors)
    if (d.set == set && d.binding == binding.binding) elements.push_back(&d);
  if (elements.empty()) return;
  if (std::ranges::any_of(elements, &Descriptor::gone)) throw Unspeakable{"descriptors of what was destroyed"};
  if (!binding.samplers.empty()) throw Unspeakable{"immutable samplers"};
  if (elements.back()->element + 1 != elements.size()) throw Unspeakable{"arrays of descriptors with holes"};
  const bool array = elements.size() > 1, sampler = binding.type == VK_DESCRIPTOR_TYPE_SAMPLER;
  const Operands names = operands_of(bug, elements);
  out << "  BIND "
      << (sampler ? plural("SAMPLER", array) + names.samplers : plural("BUFFER", array) + names.buffers + names.images);
  if (const char* const type = type_of(binding.type); *type) out << " AS " << type;
  if (binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
    out << " " << plural("SAMPLER", array) << names.samplers;
  out << " DESCRIPTOR_SET " << set << " BINDING " << binding.binding;
  if (is_dynamic(binding.type)) out << " OFFSET" << names.zeros;
  if (kind_of(binding.type) == ResourceKind::kBuffer)
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

void write_pipeline(std::ostream& out, const Bug& bug) {
  out << "PIPELINE " << (bug.dispatches() ? "compute" : "graphics") << " pipeline\n";
  for (std::size_t i = 0; i < bug.stages.size(); ++i) write_stage(out, bug.stages[i], i);
  if (!bug.dispatches()) write_state_of_draw(out, bug);
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
  for (std::size_t i = 0; i < bug.buffers.size(); ++i)
    out << "EXPECT buffer" << i << " EQ_BUFFER expected" << i << "\n";
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
    write_pipeline(out, bug);
    bug.dispatches() ? write_dispatch(out, bug) : write_draw(out, bug);
    write_expectations(out, bug);
  } catch (const Unspeakable& word) {
    return base::Error{"AmberScript is not written for " + word.what};
  }
  return out.str();
}

}  // namespace vitrine::glass::bug
