// Objects of a bug that nothing names: taken out of the lists, and the numbers of the rest made to fit.
#include <algorithm>

#include "glass/cli/reduce_steps.h"

namespace vitrine::glass::cli {
namespace {

using bug::kNone;

/// Which objects of a list stay, and what their numbers become.
class Kept {
 public:
  explicit Kept(std::size_t count) : used_(count, false) {}
  void use(std::uint32_t number) {
    if (number != kNone) used_[number] = true;
  }
  template <class T>
  void apply(std::vector<T>& objects) {
    std::uint32_t next = 0;
    numbers_.assign(used_.size(), kNone);
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) continue;
      numbers_[i] = next;
      if (next != i) objects[next] = std::move(objects[i]);
      ++next;
    }
    objects.resize(next);
  }
  void renumber(std::uint32_t& number) const {
    if (number != kNone) number = numbers_[number];
  }

 private:
  std::vector<bool> used_;
  std::vector<std::uint32_t> numbers_;
};

/// Calls f(number) for every number of a buffer, likewise for the others.
template <class F>
void for_each_buffer(bug::Bug& bug, const F& f) {
  for (bug::Descriptor& d : bug.descriptors) f(d.buffer);
  for (std::uint32_t& number : bug.addressed) f(number);
  for (bug::BufferView& view : bug.buffer_views) f(view.buffer);
  for (bug::Stream& stream : bug.streams) f(stream.buffer);
  for (bug::Stream& stream : bug.feedback) f(stream.buffer);
  f(bug.command.indices.buffer);
  f(bug.command.arguments);
  f(bug.command.count_buffer);
}
template <class F>
void for_each_view(bug::Bug& bug, const F& f) {
  for (bug::Descriptor& d : bug.descriptors) f(d.view);
  for (std::uint32_t& color : bug.rendering.colors) f(color);
  f(bug.rendering.depth);
  f(bug.rendering.stencil);
  f(bug.rendering.rate);
}
template <class F>
void for_each_sampler(bug::Bug& bug, const F& f) {
  for (bug::Descriptor& d : bug.descriptors) f(d.sampler);
  for (bug::SetLayout& set : bug.sets)
    for (bug::Binding& binding : set.bindings)
      for (std::uint32_t& sampler : binding.samplers) f(sampler);
}

/// One list: `for_each` names its users.
template <class T, class ForEach>
void drop(std::vector<T>& objects, const ForEach& for_each) {
  Kept kept(objects.size());
  for_each([&](std::uint32_t& number) { kept.use(number); });
  kept.apply(objects);
  for_each([&](std::uint32_t& number) { kept.renumber(number); });
}

}  // namespace

void drop_unused(bug::Bug& bug) {
  drop(bug.buffer_views, [&](const auto& f) {
    for (bug::Descriptor& d : bug.descriptors) f(d.texels);
  });
  drop(bug.buffers, [&](const auto& f) { for_each_buffer(bug, f); });
  drop(bug.memories, [&](const auto& f) {
    for (bug::Buffer& buffer : bug.buffers) f(buffer.memory);
  });
  drop(bug.views, [&](const auto& f) { for_each_view(bug, f); });
  drop(bug.images, [&](const auto& f) {
    for (bug::View& view : bug.views) f(view.image);
  });
  drop(bug.samplers, [&](const auto& f) { for_each_sampler(bug, f); });
}

}  // namespace vitrine::glass::cli
