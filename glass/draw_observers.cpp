// Asks each of them.
#include "glass/draw_observers.h"

#include "raster/draw_watches.h"

namespace vitrine::glass {
std::unique_ptr<raster::DrawWatch> DrawObservers::watch_chunk(const spirv::ObservedCommand* command) {
  auto watches = std::make_unique<raster::DrawWatches>();
  for (raster::DrawObserver* observer : observers_) watches->add(observer->watch_chunk(command));
  return watches;
}

std::unique_ptr<raster::DrawWatch> DrawObservers::watch_tile(const spirv::ObservedCommand* command,
                                                             std::uint32_t tile) {
  auto watches = std::make_unique<raster::DrawWatches>();
  for (raster::DrawObserver* observer : observers_) watches->add(observer->watch_tile(command, tile));
  return watches;
}

}  // namespace vitrine::glass
