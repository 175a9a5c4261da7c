#include "base/parallel.hpp"

#include <pthread.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace loopwright {
namespace {

thread_local bool inside_pool = false;

class Pool {
 public:
  explicit Pool(int threads) {
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this](std::stop_token stop) { serve(stop); });
  }
  ~Pool() {
    for (std::jthread& w : workers_) w.request_stop();
    {
      const std::lock_guard lock(mutex_);
      ++round_;
    }
    wake_.notify_all();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  void run(int chunks, const std::function<void(int)>& work) {
    {
      const std::lock_guard lock(mutex_);
      work_ = &work;
      chunks_ = chunks;
      next_ = 0;
      failed_chunk_ = chunks;
      failure_ = nullptr;
      busy_ = static_cast<int>(workers_.size());
      ++round_;
    }
    wake_.notify_all();
    take_chunks();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void take_chunks() {
    inside_pool = true;
    for (int i = next_++; i < chunks_; i = next_++) {
      try {
        (*work_)(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (i < failed_chunk_) {
          failed_chunk_ = i;
          failure_ = std::current_exception();
        }
      }
    }
    inside_pool = false;
  }

  void serve(const std::stop_token& stop) {
    long seen = 0;
    while (true) {
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return round_ != seen; });
        seen = round_;
      }
      if (stop.stop_requested()) return;
      take_chunks();
      const std::lock_guard lock(mutex_);
      if (--busy_ == 0) done_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(int)>* work_ = nullptr;
  int chunks_ = 0, busy_ = 0, failed_chunk_ = 0;
  std::atomic<int> next_{0};
  long round_ = 0;
  std::exception_ptr failure_;
  std::vector<std::jthread> workers_;  // last: joined before the rest goes
};

std::mutex pool_mutex;
int wanted_threads = 0;

// A forked process (Python's multiprocessing) has none of the threads: its pool, which would wait for them
// forever, is forgotten, not destroyed, and made anew when there is work. Nobody is in the pool while it is
// copied.
std::unique_ptr<Pool>& instance_for_this_process() {
  static std::unique_ptr<Pool> instance;
  static const int registered = pthread_atfork([] { pool_mutex.lock(); }, [] { pool_mutex.unlock(); },
                                               [] {
                                                 static_cast<void>(instance.release());
                                                 pool_mutex.unlock();
                                               });
  static_cast<void>(registered);  // without memory for it a forked process cannot work; nothing else fails
  return instance;
}

Pool& pool() {
  std::unique_ptr<Pool>& instance = instance_for_this_process();
  int threads = wanted_threads > 0 ? wanted_threads : static_cast<int>(std::thread::hardware_concurrency());
  threads = threads < 1 ? 1 : threads > 64 ? 64 : threads;
  if (!instance || instance->threads() != threads) {
    instance.reset();
    instance = std::make_unique<Pool>(threads);
  }
  return *instance;
}

}  // namespace

void set_thread_count(int threads) {
  const std::lock_guard lock(pool_mutex);
  wanted_threads = threads;
}

int thread_count() {
  const std::lock_guard lock(pool_mutex);
  return pool().threads();
}

void parallel_chunks(int chunks, const std::function<void(int)>& run) {
  if (chunks <= 1 || inside_pool) {
    for (int i = 0; i < chunks; ++i) run(i);
    return;
  }
  const std::lock_guard lock(pool_mutex);
  pool().run(chunks, run);
}

}  // namespace loopwright
