// Which objects there are and what may be done to them.
#include "tests/fuzz/objects.h"

#include <algorithm>
#include <iterator>

#include "tests/fuzz/target.h"

#define VK_CALL(name) VK_GET(d_.instance, name)

namespace vitrine::fuzz {
namespace {

/// A device that runs share.
struct Shared : Driver {
  VkPipelineCache cache = VK_NULL_HANDLE;

  Shared() {
    make_instance(*this, {});
    open();
  }
  void open() {
    make_device(*this, {}, nullptr);
    const auto info = icd::make_struct<VkPipelineCacheCreateInfo>();
    demand(VK_GET(instance, CreatePipelineCache)(device, &info, nullptr, &cache) == VK_SUCCESS, "a cache");
  }
  void close() const {
    VK_GET(instance, DestroyPipelineCache)(device, cache, nullptr);
    VK_GET(instance, DestroyDevice)(device, nullptr);
  }
};

bool reaches(const Ref& from, const Ref& thing) {
  return from &&
         (from == thing || std::ranges::any_of(from->of, [&](const Ref& next) { return reaches(next, thing); }));
}

}  // namespace

Objects::~Objects() {
  finish();
  for (Ref thing; (thing = any());) destroy(thing);
}

void Objects::go() {
  for (std::uint32_t i = c_.between(20, 150); i-- != 0;) {
    switch (c_.below(13)) {
      case 0:
      case 1:
        if (const Ref thing = any()) destroy(thing);
        break;
      case 2:
      case 3:
        record();
        break;
      case 4:
      case 5:
        submit();
        break;
      case 6:
        update_set();
        break;
      case 7:
        reset_something();
        break;
      case 8:
        make_absurd();
        break;
      default:
        make();
    }
  }
}

bool Objects::usable(const Ref& thing) const {
  return thing && thing->lives && (!thing->pool || thing->pool->lives) &&
         std::ranges::all_of(thing->of, [&](const Ref& next) { return usable(next); });
}

Ref Objects::one_of(const std::vector<Ref>& list) {
  return list.empty() ? nullptr : list[c_.below(static_cast<std::uint32_t>(list.size()))];
}

Ref Objects::one_that(base::FunctionRef<bool(const Ref&)> fits) {
  std::vector<Ref> found;
  std::ranges::copy_if(things_, std::back_inserter(found), fits);
  return one_of(found);
}

Ref Objects::some(Kind kind, std::uint32_t agreed) {
  return one_that([&](const Ref& thing) {
    return thing->kind == kind && (agreed == ~0u || thing->agreed == agreed) && usable(thing);
  });
}

Ref Objects::need(Kind kind, std::uint32_t agreed) {
  Ref found = some(kind, agreed);
  if (found) return found;
  make_of(kind, agreed);
  return some(kind, agreed);
}

Ref Objects::any() {
  std::erase_if(things_, [](const Ref& thing) { return !thing->lives; });
  return one_of(things_);
}

Ref Objects::living(Kind kind) {
  return one_that([&](const Ref& thing) { return thing->kind == kind && thing->lives; });
}

void Objects::finish() {
  if (pending_.empty()) return;
  demand(VK_CALL(QueueWaitIdle)(d_.queue) == VK_SUCCESS, "the end of what was submitted");
  pending_.clear();
}

void Objects::free_of_use(const Ref& thing) {
  const auto uses = [&](const Ref& submitted) {
    return reaches(submitted, thing) ||
           std::ranges::any_of(things_, [&](const Ref& t) { return t->pool == thing && reaches(submitted, t); });
  };
  if (std::ranges::any_of(pending_, uses)) finish();
}

void Objects::changed(const Ref& thing) {
  for (const Ref& t : things_)
    if ((t->kind == Kind::kCommands || t->kind == Kind::kSecondary) && t != thing && reaches(t, thing))
      t->ready = false;
}

void Objects::destroy(const Ref& thing) {
  free_of_use(thing);
  changed(thing);
  const auto end = [&]<class Handle>(void(VKAPI_PTR * call)(VkDevice, Handle, const VkAllocationCallbacks*)) {
    call(d_.device, as<Handle>(thing), nullptr);
  };
  switch (thing->kind) {
    case Kind::kMemory:
      end(VK_CALL(FreeMemory));
      break;
    case Kind::kBuffer:
      end(VK_CALL(DestroyBuffer));
      break;
    case Kind::kBufferView:
      end(VK_CALL(DestroyBufferView));
      break;
    case Kind::kImage:
      end(VK_CALL(DestroyImage));
      break;
    case Kind::kImageView:
      end(VK_CALL(DestroyImageView));
      break;
    case Kind::kSampler:
      end(VK_CALL(DestroySampler));
      break;
    case Kind::kSetLayout:
      end(VK_CALL(DestroyDescriptorSetLayout));
      break;
    case Kind::kTemplate:
      end(VK_CALL(DestroyDescriptorUpdateTemplate));
      break;
    case Kind::kPipelineLayout:
      end(VK_CALL(DestroyPipelineLayout));
      break;
    case Kind::kDescriptorPool:
      end(VK_CALL(DestroyDescriptorPool));
      break;
    case Kind::kSet: {
      const auto set = as<VkDescriptorSet>(thing);
      VK_CALL(FreeDescriptorSets)(d_.device, as<VkDescriptorPool>(thing->pool), 1, &set);
      break;
    }
    case Kind::kModule:
      end(VK_CALL(DestroyShaderModule));
      break;
    case Kind::kCache:
      end(VK_CALL(DestroyPipelineCache));
      break;
    case Kind::kComputePipeline:
    case Kind::kGraphicsPipeline:
      end(VK_CALL(DestroyPipeline));
      break;
    case Kind::kRenderPass:
      end(VK_CALL(DestroyRenderPass));
      break;
    case Kind::kFramebuffer:
      end(VK_CALL(DestroyFramebuffer));
      break;
    case Kind::kQueryPool:
      end(VK_CALL(DestroyQueryPool));
      break;
    case Kind::kEvent:
      end(VK_CALL(DestroyEvent));
      break;
    case Kind::kFence:
      end(VK_CALL(DestroyFence));
      break;
    case Kind::kSemaphore:
      end(VK_CALL(DestroySemaphore));
      break;
    case Kind::kCommandPool:
      end(VK_CALL(DestroyCommandPool));
      break;
    case Kind::kCommands:
    case Kind::kSecondary: {
      const auto commands = as<VkCommandBuffer>(thing);
      VK_CALL(FreeCommandBuffers)(d_.device, as<VkCommandPool>(thing->pool), 1, &commands);
      break;
    }
    case Kind::kCount:
      break;
  }
  thing->lives = false;
  end_children(thing);
}

void Objects::end_children(const Ref& pool) {
  for (const Ref& t : things_) {
    if (t->pool != pool) continue;
    changed(t);
    t->lives = false;
  }
}

}  // namespace vitrine::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vitrine::fuzz;
  static Shared shared;
  Choices choices({data, size});
  const bool last = choices.one_in(250);
  {
    Objects objects(choices, shared, shared.cache);
    objects.go();
  }
  if (last) {
    shared.close();
    shared.open();
  }
  return 0;
}
