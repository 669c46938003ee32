// Who holds which planes of the pool.
#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {

const PlaneSet& current_planes(TileWorker& worker, const Primitive& primitive) {
  if (worker.planes_of == &primitive) return *worker.planes;
  set_current_planes(worker, nullptr, nullptr);
  PlaneSet* planes = worker.pool.take();
  compute_planes(*worker.draw->plan, primitive, *planes);
  set_current_planes(worker, &primitive, planes);
  return *planes;
}

void set_current_planes(TileWorker& worker, const Primitive* primitive, PlaneSet* planes) {
  const PackedWave& wave = worker.wave;
  const bool used = wave.slots != 0 && wave.planes.set[wave.slots - 1] == worker.planes;
  if (worker.planes && !used) worker.pool.give_back(worker.planes);
  worker.planes = planes;
  worker.planes_of = primitive;
}

void release_planes(TileWorker& worker, const PackedWave& wave) {
  for (std::uint32_t slot = 0; slot < wave.slots; ++slot)
    if (wave.planes.set[slot] != worker.planes) worker.pool.give_back(wave.planes.set[slot]);
}

}  // namespace vitrine::raster
