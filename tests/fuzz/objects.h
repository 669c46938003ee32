// One run of the fuzzer of objects: makes, uses and destroys objects of every kind in any order that is valid usage:
// parents before children, makers before what they made, what is used no more while others still name it.
#pragma once

#include <memory>
#include <vector>

#include "base/function_ref.h"
#include "icd/edge/util.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/driver.h"

namespace vitrine::fuzz {

enum class Kind : std::uint8_t {
  kMemory,
  kBuffer,
  kBufferView,
  kImage,
  kImageView,
  kSampler,
  kSetLayout,
  kTemplate,
  kPipelineLayout,
  kDescriptorPool,
  kSet,
  kModule,
  kCache,
  kComputePipeline,
  kRenderPass,
  kFramebuffer,
  kGraphicsPipeline,
  kQueryPool,
  kEvent,
  kFence,
  kSemaphore,
  kCommandPool,
  kCommands,
  kSecondary,
  kCount
};

struct Thing;
using Ref = std::shared_ptr<Thing>;

struct Thing {
  Kind kind;
  std::uint64_t handle = 0;
  std::vector<Ref> of;       ///< what must live when this is used; null: has not been written, so cannot be used
  Ref pool;                  ///< what it ends with
  Ref layout;                ///< of a set
  std::uint32_t agreed = 0;  ///< sets, layouts and pipelines go together where this is the same
  bool lives = true;
  bool ready = false;  ///< command buffers: recorded; semaphores: signalled; fences: signalled or going to be
};

/// A compute shader that uses every binding, a vertex and a fragment shader.
enum class Shader : std::uint8_t { kCompute, kVertex, kFragment, kCount };

class Objects {
 public:
  /// `cache`: of the device, knows the shaders of earlier runs.
  Objects(Choices& choices, const Driver& driver, VkPipelineCache cache) : c_(choices), d_(driver), cache_(cache) {}
  /// Destroys what is left, in any order.
  ~Objects();
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;

  void go();

 private:
  static constexpr std::uint32_t kBindings = 4;

  bool usable(const Ref& thing) const;
  Ref one_of(const std::vector<Ref>& list);
  Ref one_that(base::FunctionRef<bool(const Ref&)> fits);
  /// One that can be used, of the kind; null: there is none. `agreed`: with this, ~0: any.
  Ref some(Kind kind, std::uint32_t agreed = ~0u);
  /// The same; where there is none, one is made, with what it needs, as far as that can be.
  Ref need(Kind kind, std::uint32_t agreed = ~0u);
  /// Any that lives, of the kind, used or not; null: there is none.
  Ref any();
  Ref living(Kind kind);

  /// Waits if what has been submitted uses it or what ends with it: it may be changed or destroyed then.
  void free_of_use(const Ref& thing);
  void finish();
  /// Command buffers that name it cannot be submitted any more.
  void changed(const Ref& thing);
  void destroy(const Ref& thing);
  /// What is of the pool has ended.
  void end_children(const Ref& pool);

  void make();
  void make_of(Kind kind, std::uint32_t agreed = ~0u);
  Ref keep(Kind kind, std::uint64_t handle, std::vector<Ref> of = {});
  template <class Info, class Handle>
  Ref made(Kind kind, VkResult(VKAPI_PTR* call)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
           const Info& info, std::vector<Ref> of = {}) {
    Handle handle{};
    demand(call(d_.device, &info, nullptr, &handle) == VK_SUCCESS, "an object");
    return keep(kind, reinterpret_cast<std::uint64_t>(handle), std::move(of));
  }
  void make_buffer();
  void make_image();
  void make_set_layout();
  void make_template();
  void make_module(Shader shader);
  void make_set(std::uint32_t agreed);
  VkPipelineCache some_cache();
  void make_compute_pipeline();
  void make_render_pass();
  void make_framebuffer();
  void make_graphics_pipeline();
  void make_commands(bool secondary);

  void make_absurd();

  void update_set();
  void write(const Ref& set, std::uint32_t binding);
  void reset_something();
  void record();
  void record_command(VkCommandBuffer commands, std::vector<Ref>& used, bool secondary);
  /// False: there is nothing to be bound.
  bool bind(VkCommandBuffer commands, std::vector<Ref>& used, Kind kind, VkPipelineBindPoint point);
  void compute(VkCommandBuffer commands, std::vector<Ref>& used);
  void render(VkCommandBuffer commands, std::vector<Ref>& used);
  void transfer(VkCommandBuffer commands, std::vector<Ref>& used);
  void query(VkCommandBuffer commands, std::vector<Ref>& used);
  void wait_for_event(VkCommandBuffer commands, std::vector<Ref>& used);
  void to_general(VkCommandBuffer commands, const Ref& image);
  void submit();

  Choices& c_;
  const Driver& d_;
  VkPipelineCache cache_;
  std::vector<Ref> things_;
  std::vector<Ref> pending_;  ///< what has been submitted and not been waited for, with its fences and semaphores
};

template <class Handle>
Handle as(const Ref& thing) {
  return thing ? reinterpret_cast<Handle>(thing->handle) : Handle{};
}

}  // namespace vitrine::fuzz
