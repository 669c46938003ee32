// The queue: a list of batches and, once one has to wait or is large, a thread that works through it.
#include "icd/object/queue.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <system_error>
#include <thread>

#include "base/lasting.h"
#include "base/shake.h"
#include "base/simulated_workers.h"
#include "glass/digest.h"
#include "glass/session.h"
#include "glass/sync/sync.h"
#include "glass/timeline.h"
#include "icd/object/sync.h"
#include "icd/record/command_buffer.h"
#include "icd/replay/digested_replay.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {

/// A batch on its way through the queue.
struct Batch {
  explicit Batch(const HostMemory& m) : memory(m), waits(m), command_buffers(m), calls(m), signals(m) {}

  HostMemory memory;
  Vector<SemaphoreOp> waits;
  Vector<VkCommandBuffer> command_buffers;
  Vector<QueueCall> calls;
  Vector<SemaphoreOp> signals;
  /// Temporary payloads of the semaphores when the batch was submitted: of the waits, then the signals. Empty: none.
  std::vector<std::shared_ptr<ExternalPayload>> temporary;
  std::vector<std::string> labels;  ///< of the queue when it was submitted; kept where tools are on
  VkFence fence = VK_NULL_HANDLE;
  std::uint64_t number = 0;  ///< among those of its queue
  std::uint64_t host = 0;    ///< what the host knew to be done (glass/sync/hazards.h)
  Batch* next = nullptr;
};

struct QueueWorker {
  std::mutex mutex;
  std::condition_variable changed;
  Batch* first = nullptr;
  Batch* last = nullptr;
  bool running = false;  ///< a batch is executing, on whatever thread
  bool stopping = false;
  std::thread thread;
  std::uint64_t submitted = 0;
  std::atomic<Batch*> spare = nullptr;  ///< done, for the next submission
  Queue* queue = nullptr;
  QueueWorker* next = nullptr;  ///< among those that live (LiveQueues)

  bool idle() const { return first == nullptr && !running; }
};

namespace {

/// Work below this many estimated nanoseconds stays on the submitting thread.
constexpr std::uint64_t kInlineCost = 150'000;

bool has_temporary_payloads(const BatchInfo& info) {
  const auto has = [](const SemaphoreOp& op) { return from_handle<Semaphore>(op.semaphore).temporary != nullptr; };
  return std::ranges::any_of(info.waits, has) || std::ranges::any_of(info.signals, has);
}

/// What is submitted from here on meets the payloads that the semaphores of the waits had before (Vulkan 1.3.239,
/// Synchronization and Cache Control: Importing Semaphore Payloads).
void take_temporary_payloads(Batch& batch) noexcept {
  if (batch.temporary.empty()) return;
  std::size_t i = 0;
  for (const SemaphoreOp& op : batch.waits)
    batch.temporary[i++] = std::move(from_handle<Semaphore>(op.semaphore).temporary);
  for (const SemaphoreOp& op : batch.signals) batch.temporary[i++] = from_handle<Semaphore>(op.semaphore).temporary;
}

/// The queue's spare one, or one of new memory.
Batch* empty_batch(Queue& queue) {
  if (Batch* const spare = queue.worker->spare.exchange(nullptr)) return spare;
  const HostMemory& memory = queue.device.memory;
  void* storage = memory.allocate(sizeof(Batch), alignof(Batch), VK_SYSTEM_ALLOCATION_SCOPE_DEVICE);
  return ::new (storage) Batch(memory);
}

void free_batch(Batch* batch) noexcept {
  const HostMemory memory = batch->memory;
  batch->~Batch();
  memory.free(batch);
}

/// Keeps one that is done for the next submission, with the room of its lists.
void put_back(QueueWorker& worker, Batch* batch) noexcept {
  batch->temporary.clear();
  batch->labels.clear();
  batch->host = 0;
  batch->next = nullptr;
  Batch* none = nullptr;
  if (!worker.spare.compare_exchange_strong(none, batch)) free_batch(batch);
}

Batch* make_batch(Queue& queue, const BatchInfo& info) {
  Batch* const batch = empty_batch(queue);
  try {
    batch->waits.assign(info.waits.begin(), info.waits.end());
    if (has_temporary_payloads(info)) batch->temporary.resize(info.waits.size() + info.signals.size());
    batch->command_buffers.assign(info.command_buffers.begin(), info.command_buffers.end());
    batch->calls.assign(info.calls.begin(), info.calls.end());
    batch->signals.assign(info.signals.begin(), info.signals.end());
    batch->fence = info.fence;
    batch->number = ++queue.worker->submitted;
    if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&queue.device)) batch->host = hazards->host();
    if (!glass::session().idle()) {
      const std::lock_guard lock(queue.label_mutex);
      batch->labels = queue.labels.open();
    }
  } catch (...) {
    free_batch(batch);
    throw;
  }
  return batch;
}

/// Batches between creation and the queue.
class BatchList {
 public:
  ~BatchList() {
    while (first_) free_batch(take());
  }
  void append(Batch* batch) {
    (last_ ? last_->next : first_) = batch;
    last_ = batch;
  }
  Batch* take() {
    Batch* batch = first_;
    first_ = batch->next;
    if (!first_) last_ = nullptr;
    batch->next = nullptr;
    return batch;
  }
  bool empty() const { return first_ == nullptr; }

 private:
  Batch* first_ = nullptr;
  Batch* last_ = nullptr;
};

/// False if the device was lost.
bool replay_all(Device& device, Batch& batch) {
  const base::SimulatedWork work;
  begin_observed_submission(device, std::move(batch.labels), batch.host);
  if (device.replay->observed && glass::has_digest()) digest_submission(*device.replay);
  const bool done = std::all_of(batch.command_buffers.begin(), batch.command_buffers.end(), [&](VkCommandBuffer b) {
    return replay(device, from_handle<CommandBuffer>(b)) == VK_SUCCESS;
  });
  end_observed_submission(device);
  return done;
}

/// Whether others can signal each of the semaphores that a batch has waited for. None once the device is lost: they may
/// be gone.
std::vector<bool> shared_waits(Device& device, const Batch& batch) {
  std::vector<bool> shared;
  const std::lock_guard lock(device.sync_mutex);
  if (device.lost) return shared;
  for (const SemaphoreOp& op : batch.waits) shared.push_back(from_handle<Semaphore>(op.semaphore).shared != nullptr);
  return shared;
}

/// What the tool sync is told of a batch's semaphores and fence (glass/sync/hazards.h).
void tell_waits(Device& device, const Batch& batch) {
  glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device);
  if (!hazards) return;
  if (batch.calls.empty()) {
    const std::vector<bool> shared = shared_waits(device, batch);
    for (std::size_t i = 0; i < shared.size(); ++i) {
      const SemaphoreOp& op = batch.waits[i];
      hazards->wait(&from_handle<Semaphore>(op.semaphore), op.value,
                    glass::sync::second_scope(op.stages, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT),
                    shared[i] || !batch.temporary.empty());
    }
    return;
  }
  std::vector<const void*> semaphores;
  for (const SemaphoreOp& op : batch.waits) semaphores.push_back(&from_handle<Semaphore>(op.semaphore));
  std::vector<glass::sync::Hazards::SwapchainImage> images;
  for (const QueueCall& call : batch.calls) images.emplace_back(call.object, call.argument);
  hazards->present(images, semaphores);
}

void tell_signals(Device& device, const Batch& batch) {
  glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device);
  if (!hazards) return;
  for (const SemaphoreOp& op : batch.signals)
    hazards->signal(&from_handle<Semaphore>(op.semaphore), op.value,
                    glass::sync::first_scope(op.stages, VK_ACCESS_2_MEMORY_WRITE_BIT));
  if (batch.fence) hazards->signal_fence(&from_handle<Fence>(batch.fence));
}

/// What `act` says, for what tools note of a batch. False, too, if the memory for it is exhausted: the device is then
/// lost, as with memory for a command.
template <class F>
bool with_memory(Device& device, F&& act) noexcept {
  try {
    return act();
  } catch (const std::bad_alloc&) {
    lose_device(device, {});
    return false;
  }
}

/// Executes one batch on the calling thread. After a device loss only the fences and swapchains are still served, so
/// that nobody waits for ever.
void execute(Device& device, Batch& batch) noexcept {
  bool lost = false;
  base::restart_choices(batch.number);
  const glass::Span span("queue", "submission");
  const auto temporary = [&](std::size_t i) { return batch.temporary.empty() ? nullptr : batch.temporary[i]; };
  for (std::size_t i = 0; i < batch.waits.size(); ++i) {
    const glass::Span wait("wait", "wait for semaphore");
    const SemaphoreOp& op = batch.waits[i];
    lost |= !wait_semaphore(device, from_handle<Semaphore>(op.semaphore), op.value, temporary(i));
  }
  lost |= !with_memory(device, [&] { return tell_waits(device, batch), true; });
  if (!lost && !batch.command_buffers.empty()) lost = !with_memory(device, [&] { return replay_all(device, batch); });
  for (const QueueCall& call : batch.calls) {
    const glass::Span present("present", "present");
    call.run(call.object, call.argument);
  }
  if (lost || !with_memory(device, [&] { return tell_signals(device, batch), true; })) return;
  for (std::size_t i = 0; i < batch.signals.size(); ++i) {
    const SemaphoreOp& op = batch.signals[i];
    signal_semaphore(device, from_handle<Semaphore>(op.semaphore), op.value, temporary(batch.waits.size() + i));
  }
  if (batch.fence) signal_fence(device, from_handle<Fence>(batch.fence));
}

/// Whether executing the batch now cannot block, and is short.
bool fits_inline(Device& device, const BatchInfo& info) {
  std::uint64_t cost = 0;
  for (const VkCommandBuffer handle : info.command_buffers) {
    const CommandBuffer& buffer = from_handle<CommandBuffer>(handle);
    if (buffer.waits_for_host) return false;
    cost += buffer.cost;
  }
  if (cost > kInlineCost || has_temporary_payloads(info)) return false;
  const std::lock_guard lock(device.sync_mutex);
  return std::all_of(info.waits.begin(), info.waits.end(),
                     [](const SemaphoreOp& op) { return is_reached(from_handle<Semaphore>(op.semaphore), op.value); });
}

/// Up to four milliseconds: long enough for the application to have read what is not there yet.
void delay(const Batch& batch) {
  base::restart_choices(batch.number);
  std::this_thread::sleep_for(std::chrono::microseconds(base::next_choice() % 4000));
}

void work(Queue& queue, QueueWorker& worker) {
  pthread_setname_np(pthread_self(), "vitrine-queue");
  std::unique_lock lock(worker.mutex);
  for (;;) {
    worker.changed.wait(lock, [&] { return worker.stopping || (worker.first && !worker.running); });
    if (!worker.first || worker.running) {
      if (worker.stopping) return;
      continue;
    }
    Batch* batch = worker.first;
    worker.first = batch->next;
    if (!worker.first) worker.last = nullptr;
    worker.running = true;
    lock.unlock();
    if (base::shakes(base::ShakeKind::kDelays)) delay(*batch);
    execute(queue.device, *batch);
    put_back(worker, batch);
    lock.lock();
    worker.running = false;
    worker.changed.notify_all();
  }
}

/// Runs the batches here, each while the queue is marked busy. The caller has marked it.
void run_inline(Queue& queue, QueueWorker& worker, BatchList& list) noexcept {
  while (!list.empty()) {
    Batch* batch = list.take();
    take_temporary_payloads(*batch);
    execute(queue.device, *batch);
    put_back(worker, batch);
  }
  const std::lock_guard lock(worker.mutex);
  worker.running = false;
  worker.changed.notify_all();
}

/// All queues of the process, for fork(): the child has one thread, not those that the devices of its parent wait for,
/// and shares their memory with it. There they are lost, so that nobody waits for ever, and can be destroyed.
class LiveQueues {
 public:
  LiveQueues() { pthread_atfork(&prepare, &go_on, &lose); }

  void add(QueueWorker& worker) {
    const std::lock_guard lock(mutex_);
    worker.next = first_;
    first_ = &worker;
  }
  void remove(const QueueWorker& worker) {
    const std::lock_guard lock(mutex_);
    QueueWorker** place = &first_;
    while (*place != &worker) place = &(*place)->next;
    *place = worker.next;
  }

 private:
  /// So that no thread that the child does not have is in the middle of something.
  static void prepare();
  static void go_on();
  static void lose();

  template <class F>
  void for_each(F&& f) {
    for (QueueWorker* worker = first_; worker; worker = worker->next) f(*worker, worker->queue->device);
  }

  std::mutex mutex_;
  QueueWorker* first_ = nullptr;
};

LiveQueues& live_queues() {
  static LiveQueues& queues = base::lasting([] { return LiveQueues(); });
  return queues;
}

void LiveQueues::prepare() {
  live_queues().mutex_.lock();
  live_queues().for_each([](QueueWorker& worker, Device& device) {
    worker.mutex.lock();
    device.sync_mutex.lock();
  });
}

void LiveQueues::go_on() {
  live_queues().for_each([](QueueWorker& worker, Device& device) {
    device.sync_mutex.unlock();
    worker.mutex.unlock();
  });
  live_queues().mutex_.unlock();
}

/// What threads of the parent hold or wait at (a condition variable's waiters, too) is left as it is and made anew.
void LiveQueues::lose() {
  live_queues().for_each([](QueueWorker& worker, Device& device) {
    device.lost = true;
    device.loss.reason = "the process is a child that fork() made of the device's";
    ::new (&device.sync_changed) std::condition_variable;
    ::new (&worker.changed) std::condition_variable;
    ::new (&worker.thread) std::thread;
    worker.first = worker.last = nullptr;
    worker.running = false;
  });
  go_on();
}

/// False when the system has no thread to give.
bool start_thread(Queue& queue, QueueWorker& worker) {
  if (worker.thread.joinable()) return true;
  try {
    worker.thread = std::thread([&queue, &worker] { work(queue, worker); });
  } catch (const std::system_error&) {
    return false;
  }
  return true;
}

}  // namespace

void start_queue(Queue& queue) {
  LiveQueues& live = live_queues();  // may throw: a worker that is there is among them
  const HostMemory& memory = queue.device.memory;
  void* storage = memory.allocate(sizeof(QueueWorker), alignof(QueueWorker), VK_SYSTEM_ALLOCATION_SCOPE_DEVICE);
  queue.worker = ::new (storage) QueueWorker;
  queue.worker->queue = &queue;
  live.add(*queue.worker);
}

void stop_queue(Queue& queue) noexcept {
  QueueWorker* worker = queue.worker;
  if (!worker) return;
  live_queues().remove(*worker);
  {
    const std::lock_guard lock(worker->mutex);
    worker->stopping = true;
  }
  worker->changed.notify_all();
  if (worker->thread.joinable()) worker->thread.join();
  if (Batch* const spare = worker->spare) free_batch(spare);
  worker->~QueueWorker();
  queue.device.memory.free(worker);
  queue.worker = nullptr;
}

VkResult submit(Queue& queue, std::span<const BatchInfo> batches) {
  if (is_lost(queue.device)) return VK_ERROR_DEVICE_LOST;
  QueueWorker& worker = *queue.worker;
  BatchList list;
  for (const BatchInfo& info : batches) list.append(make_batch(queue, info));
  const bool small = !base::shakes(base::ShakeKind::kDelays) &&
                     std::all_of(batches.begin(), batches.end(),
                                 [&](const BatchInfo& info) { return fits_inline(queue.device, info); });
  std::unique_lock lock(worker.mutex);
  if ((small && worker.idle()) || !start_thread(queue, worker)) {
    worker.changed.wait(lock, [&] { return worker.idle(); });
    worker.running = true;
    lock.unlock();
    run_inline(queue, worker, list);
    return is_lost(queue.device) ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
  }
  while (!list.empty()) {
    Batch* batch = list.take();
    take_temporary_payloads(*batch);
    (worker.last ? worker.last->next : worker.first) = batch;
    worker.last = batch;
  }
  lock.unlock();
  worker.changed.notify_all();
  return VK_SUCCESS;
}

VkResult wait_idle(Queue& queue) {
  const glass::Span span("wait", "wait for idle queue");
  QueueWorker& worker = *queue.worker;
  {
    std::unique_lock lock(worker.mutex);
    worker.changed.wait(lock, [&] { return worker.idle(); });
  }
  if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&queue.device)) hazards->host_waited_for_all();
  return is_lost(queue.device) ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

}  // namespace vitrine::icd
