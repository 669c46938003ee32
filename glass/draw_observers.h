// Several observers of draws as one.
#pragma once

#include <vector>

#include "raster/observe.h"

namespace vitrine::glass {

class DrawObservers : public raster::DrawObserver {
 public:
  void add(raster::DrawObserver& observer) { observers_.push_back(&observer); }
  /// All of them; null: there is none.
  raster::DrawObserver* observer() {
    if (observers_.size() > 1) return this;
    return observers_.empty() ? nullptr : observers_[0];
  }

  std::unique_ptr<raster::DrawWatch> watch_chunk(const spirv::ObservedCommand* command) override;
  std::unique_ptr<raster::DrawWatch> watch_tile(const spirv::ObservedCommand* command, std::uint32_t tile) override;

 private:
  std::vector<raster::DrawObserver*> observers_;
};

}  // namespace vitrine::glass
