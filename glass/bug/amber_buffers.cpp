// See amber_buffers.h.
#include "glass/bug/amber_buffers.h"

#include <algorithm>

#include "glass/bug/contents.h"

namespace vitrine::glass::bug {
namespace {

/// BUFFER with its data, of texels if it has a format, else of words where that goes.
void write_buffer(std::ostream& out, const std::string& name, const Bytes& bytes,
                  VkFormat format = VK_FORMAT_UNDEFINED) {
  if (format != VK_FORMAT_UNDEFINED) return write_texel_buffer(out, name, bytes, format);
  write_numbers(out, name, bytes, bytes.size() % 4 == 0 ? 4 : 1);
}

/// The format in which texel buffers show all of a buffer. Undefined: there are none, or they show parts of it or show
/// it in several formats.
VkFormat format_of_whole(const Bug& bug, std::uint32_t number) {
  VkFormat format = VK_FORMAT_UNDEFINED;
  for (const BufferView& view : bug.buffer_views) {
    if (view.buffer != number) continue;
    const bool whole = view.offset == 0 && view.range >= bug.buffers[number].size;
    if (!whole || (format != VK_FORMAT_UNDEFINED && format != view.format)) return VK_FORMAT_UNDEFINED;
    format = view.format;
  }
  return format;
}

bool is_apart(const Bug& bug, const BufferView& view) {
  return format_of_whole(bug, view.buffer) == VK_FORMAT_UNDEFINED;
}

/// Whether anything but a view that is apart binds a buffer. (Indices and arguments are looked at where they are
/// written.)
bool is_bound(const Bug& bug, std::uint32_t number) {
  return std::ranges::any_of(bug.descriptors, [&](const Descriptor& d) { return d.buffer == number; }) ||
         std::ranges::any_of(bug.streams, [&](const Stream& s) { return s.buffer == number; }) ||
         std::ranges::none_of(bug.buffer_views, [&](const BufferView& v) { return v.buffer == number; }) ||
         format_of_whole(bug, number) != VK_FORMAT_UNDEFINED;
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

/// The whole texels of a view.
Bytes texels_of(const Bug& bug, const BufferView& view, bool after) {
  const Bytes all = contents_of(bug, bug.buffers[view.buffer], after);
  const std::uint64_t texel = texel::format_desc(view.format).block_bytes;
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(view.offset);
  return {first, first + static_cast<std::ptrdiff_t>(view.range / texel * texel)};
}

/// What others see of the buffer, too, must stay as it is: a view that is apart has a copy.
void demand_alone(const Bug& bug, std::size_t number) {
  const BufferView& view = bug.buffer_views[number];
  if (texels_of(bug, view, false) == texels_of(bug, view, true)) return;
  const auto meets = [&](const BufferView& other) {
    return other.buffer == view.buffer && other.offset < view.offset + view.range &&
           view.offset < other.offset + other.range;
  };
  const auto shown = std::ranges::count_if(bug.buffer_views, meets);
  if (shown > 1 || is_bound(bug, view.buffer))
    throw Unspeakable{"texel buffers that change and show parts of a buffer that is bound otherwise, too"};
}

std::string texels_name(std::size_t number) { return "texels" + std::to_string(number); }
std::string name_of(std::size_t number) { return "buffer" + std::to_string(number); }

/// An inline uniform block is a buffer of its own: shaders do not tell them apart.
std::string block_name(const Descriptor& d) {
  return "block" + std::to_string(d.set) + "_" + std::to_string(d.binding);
}

void write_views(std::ostream& out, const Bug& bug) {
  for (std::size_t i = 0; i < bug.buffer_views.size(); ++i) {
    const BufferView& view = bug.buffer_views[i];
    if (!is_apart(bug, view)) continue;
    demand_alone(bug, i);
    write_buffer(out, texels_name(i), texels_of(bug, view, false), view.format);
    if (!bug.lost) write_buffer(out, "expected_" + texels_name(i), texels_of(bug, view, true), view.format);
  }
}

}  // namespace

void write_buffers(std::ostream& out, const Bug& bug) {
  if (!bug.addressed.empty()) throw Unspeakable{"shaders that follow device addresses"};
  for (std::uint32_t i = 0; i < bug.buffers.size(); ++i) {
    if (overlaps(bug, i)) throw Unspeakable{"buffers that overlap"};
    if (!is_bound(bug, i)) continue;
    if (!bug.buffers[i].name.empty()) out << "# " << bug.buffers[i].name << "\n";
    const VkFormat format = format_of_whole(bug, i);
    write_buffer(out, name_of(i), contents_of(bug, bug.buffers[i], false), format);
    if (!bug.lost) write_buffer(out, "expected" + std::to_string(i), contents_of(bug, bug.buffers[i], true), format);
  }
  write_views(out, bug);
  for (const Descriptor& d : bug.descriptors)
    if (d.bytes) write_buffer(out, block_name(d), *d.bytes);
  if (bug.push_constants && !bug.push_constants->empty()) write_buffer(out, "pushed", *bug.push_constants);
  out << "\n";
}

void write_expectations_of_buffers(std::ostream& out, const Bug& bug) {
  for (std::uint32_t i = 0; i < bug.buffers.size(); ++i)
    if (is_bound(bug, i)) out << "EXPECT " << name_of(i) << " EQ_BUFFER expected" << i << "\n";
  for (std::size_t i = 0; i < bug.buffer_views.size(); ++i)
    if (is_apart(bug, bug.buffer_views[i]))
      out << "EXPECT " << texels_name(i) << " EQ_BUFFER expected_" << texels_name(i) << "\n";
}

std::string buffer_name(const Bug& bug, const Descriptor& d) {
  if (d.bytes) return block_name(d);
  if (d.texels == kNone) return d.buffer == kNone ? "" : name_of(d.buffer);
  const BufferView& view = bug.buffer_views[d.texels];
  return is_apart(bug, view) ? texels_name(d.texels) : name_of(view.buffer);
}

}  // namespace vitrine::glass::bug
