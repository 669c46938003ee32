// The worker pool: sleeping threads that share an atomic item counter per parallel loop.
#include "base/workers.h"

#include "base/lasting.h"
#include "base/loop_watch.h"
#include "base/shake.h"
#include "base/simulated_workers.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace vitrine::base {
namespace {

std::atomic<LoopWatch> loop_watch{nullptr};
thread_local bool inside_loop = false;
thread_local std::size_t current_worker = 0;

std::size_t wanted_workers() {
  if (simulated_workers() != 0) return simulated_workers();
  if (const char* value = std::getenv("VITRINE_THREADS")) {
    const long count = std::strtol(value, nullptr, 10);
    if (count > 0) return static_cast<std::size_t>(std::min(count, 256L));
  }
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  if (sched_getaffinity(0, sizeof(cpus), &cpus) == 0) {
    const int count = CPU_COUNT(&cpus);
    if (count > 0) return static_cast<std::size_t>(count);
  }
  return 1;
}

struct Loop {
  std::size_t count;
  FunctionRef<void(std::size_t, std::size_t)> body;
  std::atomic<std::size_t> next{};
  std::mutex failure_mutex{};
  std::exception_ptr failure{};  // the first one

  void run(std::size_t worker) noexcept {
    const LoopWatch watch = loop_watch.load(std::memory_order_relaxed);
    if (!watch) return static_cast<void>(work(worker));
    const auto begin = std::chrono::steady_clock::now();
    if (const std::size_t items = work(worker); items != 0) watch(begin, std::chrono::steady_clock::now(), items);
  }

 private:
  /// How many items this thread has begun.
  std::size_t work(std::size_t worker) noexcept {
    std::size_t items = 0;
    try {
      for (std::size_t i = next.fetch_add(1, std::memory_order_relaxed); i < count;
           i = next.fetch_add(1, std::memory_order_relaxed)) {
        ++items;
        body(i, worker);
      }
    } catch (...) {
      next.store(count, std::memory_order_relaxed);
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
    return items;
  }
};

/// Marks the calling thread as one that works on a loop.
class InsideLoop {
 public:
  InsideLoop() { inside_loop = true; }
  ~InsideLoop() { inside_loop = before_; }
  InsideLoop(const InsideLoop&) = delete;
  InsideLoop& operator=(const InsideLoop&) = delete;

 private:
  const bool before_ = inside_loop;
};

class Pool {
 public:
  explicit Pool(std::size_t threads) : size_(threads) {}

  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  std::size_t size() const { return size_; }

  void run(Loop& loop) {
    // One loop at a time: a second queue thread waits its turn instead of sharing workers.
    const std::lock_guard one_loop(loop_mutex_);
    start_threads();
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      wanted_ = std::min(threads_.size(), loop.count - 1);
      ++generation_;
    }
    if (wanted_ == threads_.size()) {
      wake_.notify_all();
    } else {
      for (std::size_t i = 0; i < wanted_; ++i) wake_.notify_one();
    }
    current_worker = 0;
    {
      const InsideLoop inside;
      loop.run(0);
    }
    std::unique_lock lock(mutex_);
    loop_ = nullptr;  // late risers find nothing to do
    done_.wait(lock, [this] { return running_ == 0; });
    if (loop.failure) std::rethrow_exception(loop.failure);
  }

 private:
  void start_threads() {
    while (!exhausted_ && threads_.size() + 1 < size_) {
      try {
        threads_.emplace_back([this, worker = threads_.size() + 1] { work(worker); });
      } catch (const std::system_error&) {
        exhausted_ = true;  // those that there are do the work
      } catch (const std::bad_alloc&) {
        break;  // the next loop tries again
      }
    }
  }

  void work(std::size_t worker) {
    pthread_setname_np(pthread_self(), "vitrine-worker");
    inside_loop = true;
    current_worker = worker;
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return stopping_ || (loop_ && generation_ != seen); });
      if (stopping_) return;
      seen = generation_;
      Loop* loop = loop_;
      ++running_;
      lock.unlock();
      loop->run(worker);
      lock.lock();
      if (--running_ == 0) done_.notify_one();
    }
  }

  const std::size_t size_;
  std::mutex loop_mutex_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<std::thread> threads_;
  Loop* loop_ = nullptr;
  std::size_t wanted_ = 0;
  std::size_t running_ = 0;
  std::uint64_t generation_ = 0;
  bool stopping_ = false;
  bool exhausted_ = false;
};

Pool& pool();

/// In a child that fork() made, which has this thread alone: the parent's pool is left as it is, since what its threads
/// held stays held, and another one takes its place.
void replace_pool() { std::construct_at(&pool(), pool().size()); }

Pool& pool() {
  static Pool& instance = lasting([] {
    pthread_atfork(nullptr, nullptr, &replace_pool);
    return Pool(wanted_workers());
  });
  return instance;
}

/// On the calling thread, so that the order is the same every time.
void run_shuffled(std::size_t count, FunctionRef<void(std::size_t, std::size_t)> body) {
  if (!inside_loop) current_worker = 0;
  const Shuffle shuffle(count, next_choice());
  const InsideLoop inside;
  for (std::size_t i = 0; i < count; ++i) body(static_cast<std::size_t>(shuffle(i)), current_worker);
}

}  // namespace

void set_loop_watch(LoopWatch watch) { loop_watch = watch; }

std::size_t worker_count() { return pool().size(); }

void parallel_for(std::size_t count, FunctionRef<void(std::size_t, std::size_t)> body) {
  if (count == 0) return;
  if (shakes(ShakeKind::kOrder)) return run_shuffled(count, body);
  if (simulated_workers() != 0 && count > 1 && !inside_loop) {
    const InsideLoop inside;
    return simulate_loop(count, [&](std::size_t index, std::size_t worker) {
      current_worker = worker;
      body(index, worker);
    });
  }
  if (count == 1 || inside_loop || pool().size() == 1) {
    if (!inside_loop) current_worker = 0;
    const InsideLoop inside;
    for (std::size_t i = 0; i < count; ++i) body(i, current_worker);
    return;
  }
  Loop loop{count, body};
  pool().run(loop);
}

}  // namespace vitrine::base
