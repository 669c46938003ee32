// The accesses of a device's commands in the order of submission, held against each other: two that touch the same
// bytes, one of them a write, without the dependency that they need (Vulkan 1.3.239, Synchronization and Cache
// Control). icd/ tells of commands, dependencies, semaphores and fences, the tool's watches of what shaders touch.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "glass/sync/layouts.h"
#include "glass/sync/records.h"

namespace vitrine::glass::sync {

/// What a command does to some bytes.
struct Touch {
  Use use;
  std::uint64_t pass = 0;
  std::vector<Range> ranges;
  std::shared_ptr<const Who> who;
  /// Instead of ranges: what is read is in one of these, and which is not known (levels of an image).
  std::vector<std::vector<Range>> alternatives{};
  Tag since = ~Tag{0};  ///< behind all that happened from then on: store operations are behind their pass
  std::shared_ptr<const Several> several{};
};

/// One memory barrier.
struct Barrier {
  Scope first, second;
  std::vector<Range> ranges;                  ///< of a buffer or image
  bool is_global = false;                     ///< of all memory
  std::shared_ptr<const Who> who;             ///< of a transition of the layout; null: it is none
  std::vector<std::pair<Scope, Scope>> more;  ///< dependencies that the transition is a part of, too
};

class Hazards {
 public:
  /// A command that begins: what shaders of it touch has this tag, too.
  void touch(Tag tag, Touch touch);
  /// Barriers of one command; those before it have been told of.
  void depend(Tag tag, std::span<const Barrier> barriers);

  // Events: what happens before the one is set; the barriers of the wait for several.
  void set_event(const void* event, Tag tag, const Scope& first);
  void set_event_by_host(const void* event);
  void wait_events(std::span<const void* const> events, Tag tag, std::span<const Barrier> barriers);

  // Semaphores, of the queue that runs at that moment. `value`: of a timeline; else 0.
  void signal(const void* semaphore, std::uint64_t value, const Scope& first);
  /// `from_outside`: another device may have signalled it, behind whatever of this one it has waited for: all is taken
  /// to be done then.
  void wait(const void* semaphore, std::uint64_t value, const Scope& second, bool from_outside = false);
  void signal_by_host(const void* semaphore, std::uint64_t value);
  /// Images go to the presentation engine behind what these semaphores wait for, and come back.
  using SwapchainImage = std::pair<const void*, std::uint32_t>;
  void present(std::span<const SwapchainImage> images, std::span<const void* const> semaphores);
  void acquire(const SwapchainImage& image, const void* semaphore, const void* fence);

  /// A submission begins that the host made when it knew that all up to `host` is done.
  void begin_submission(std::uint64_t number, Tag host);
  /// All that the submission did has been told of.
  void end_submission();
  /// What the host knows to be done.
  Tag host() const;
  void signal_fence(const void* fence);
  /// The host has waited for it, or for the timeline semaphore's value, or for the queue.
  void host_waited(const void* fence);
  void host_waited_for(const void* semaphore, std::uint64_t value);
  void host_waited_for_all();
  /// The host reads bytes, or has written them.
  void host_access(const Range& range, bool write, std::shared_ptr<const Who> who);

  /// The layouts of images.
  Layouts& layouts() { return layouts_; }
  /// A command does something wrong by itself.
  void report(Tag tag, const Finding& finding);

  /// Memory that is gone.
  void forget(const Range& range);
  /// Everything that was touched is held against what came before it.
  void settle();
  std::vector<Finding> take();

 private:
  struct Event {
    Scope first;
    Tag tag = 0;
    Clock clock;
  };
  struct Signal {
    std::uint64_t value = 0;
    Clock clock;
    Tag tag = 0;  ///< of the last command before it
  };
  /// Two accesses that clash.
  struct Clash {
    const Past* earlier = nullptr;
    Past later;
    Standing standing{};
    Range bytes;
  };
  struct Entry {
    std::uint64_t count = 0;
    Tag last = 0;
    std::pair<Tag, Tag> first;
    Finding finding;
    bool delivered = false;
  };

  void settle_locked();
  void apply(Tag tag, const Touch& touch);
  void apply_alternatives(const Past& access, const Touch& touch);
  void check(const Range& bytes, const State& state, const Past& access, Tag since);
  void pass(State& state, Tag tag, const Barrier& barrier, const Clock& before);
  void transition(const Range& bytes, State& state, Tag tag, const Barrier& barrier, const Clock& before);
  bool is_done(const Past& past) const { return !past.who || past.tag <= floor_; }
  void add(const Clash& clash);
  void apply(Tag tag, std::span<const Barrier> barriers, std::span<const Clock> before);
  Signal* find_signal(const void* semaphore, std::uint64_t value);
  Tag now() const { return end_of_submission(submission_); }

  mutable std::mutex mutex_;
  Order order_;
  Records records_;
  std::map<Tag, std::vector<Touch>> pending_;
  std::map<const void*, Event> events_;
  std::map<const void*, std::vector<Signal>> signals_;
  std::map<const void*, Tag> fences_;
  std::map<SwapchainImage, Signal> presented_;
  Layouts layouts_;
  std::map<std::string, Entry> entries_;
  std::uint64_t submission_ = 0;
  Tag floor_ = 0;  ///< what happened up to then happens before all that is touched from now on
  Tag host_ = 0;
  std::size_t pruned_size_ = 0;
};

}  // namespace vitrine::glass::sync
