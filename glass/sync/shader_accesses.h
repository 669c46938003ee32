// What shaders touch, kept until the work of their commands is done.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "glass/sync/byte_set.h"
#include "glass/sync/hazards.h"
#include "glass/sync/sites.h"
#include "raster/draw.h"

namespace vitrine::glass::sync {

/// What one thread has seen a program of one command do.
struct Touches {
  explicit Touches(std::size_t sites) : bytes(sites) {}
  std::vector<ByteSet> bytes;  ///< by site
  std::map<std::size_t, std::vector<ByteSet>>
      levels;  ///< of lookups of which the level is not known, by site and level
};

class ShaderAccesses {
 public:
  /// Where the calling thread keeps what the program touches for the wave's command; null: nobody asks.
  Touches* here(const Sites& program, const spirv::ObservedCommand* command);
  /// Tells of all that commands of `owner` have touched, in an order that does not depend on threads.
  void tell(const void* owner, Hazards& hazards);

 private:
  using Key = std::pair<const spirv::ObservedCommand*, const Sites*>;
  struct Thread {
    std::mutex mutex;
    std::map<Key, Touches> touches;
    Key recent{};
    Touches* found = nullptr;  ///< of `recent`
  };
  Thread& thread();

  std::mutex mutex_;
  std::map<std::thread::id, std::unique_ptr<Thread>> threads_;
};

/// An instruction that accesses memory or an image is about to run.
void record_access(Touches& touches, const Sites& program, const spirv::Wave& wave, const spirv::Instruction* i,
                   const spirv::InstructionNote& note);

/// The indices and vertex attributes that a draw reads.
void touch_vertices(Hazards& hazards, const raster::DrawCall& call);

}  // namespace vitrine::glass::sync
