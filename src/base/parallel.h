#pragma once

#include <spawnfield/types.h>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

namespace spawnfield {

/// Returns how many threads are meant; 0: all cores.
inline int thread_count(int threads) { return threads > 0 ? threads : tbb::info::default_concurrency(); }

/// Returns how many threads a loop uses that may use `threads` (0: all cores): not more than TBB may use in this
/// process.
inline int allowed_threads(int threads)
{
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(thread_count(threads), int(allowed));
}

/// A call of work() on one of the threads that parallel_for uses, while the thread that makes this object goes on.
/// Without a call if there is to be only one thread. work() must not throw. The destructor waits for the call, so that
/// the process does not end during it.
///
/// Linux may start a thread on the core of the one that made it, and move it only after some milliseconds. After the
/// call, it has most likely got a core of its own, which the first parallel_for needs.
class CallAside {
public:
    template <class Work>
    CallAside(int threads, const Work& work)
    {
        const int count = allowed_threads(threads);
        if (count < 2) return;
        arena_.initialize(count);
        arena_.execute([&] { calls_.run(work); });
    }
    CallAside(const CallAside&) = delete;
    CallAside& operator=(const CallAside&) = delete;
    ~CallAside()
    {
        if (arena_.is_active()) arena_.execute([&] { calls_.wait(); });
    }

private:
    tbb::task_arena arena_;
    tbb::task_group calls_;
};

/// A value for each thread that asks for one, made when the thread asks first. Any thread may call local().
template <class T>
using PerThread = tbb::enumerable_thread_specific<T>;

/// Calls body(i) for each i < count on at most `threads` threads (0: all cores), but not on more than TBB may use in
/// this process. The threads have an arena of their own, so the rest of the process is not affected. Each i must write
/// only to its own slot. `progress` is called after items. An exception from it or from body ends the loop and reaches
/// the caller.
template <class Body>
void parallel_for(std::size_t count, int threads, const Progress& progress, const Body& body)
{
    std::atomic<std::size_t> done{0};
    std::mutex reporting;
    // For the thread sanitizer, which cannot see the synchronisation inside TBB because TBB is not compiled for it. The
    // flags show the order: first the code before the loop, then the calls of body, then the code after the loop, also
    // after an exception.
    std::atomic<bool> started{false}, finished{false};
    struct AtEnd {
        std::atomic<bool>& flag;
        ~AtEnd() { flag.exchange(true, std::memory_order_acq_rel); }
    };
    const AtEnd end{finished};
    started.store(true, std::memory_order_release);
    const auto run = [&](const tbb::blocked_range<std::size_t>& range) {
        static_cast<void>(started.load(std::memory_order_acquire));
        const AtEnd end_of_part{finished};
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            body(i);
            if (!progress) continue;
            const std::size_t now = ++done;
            if (const std::unique_lock lock(reporting, std::try_to_lock); lock) progress(double(now) / double(count));
        }
    };
    tbb::task_arena arena(allowed_threads(threads));
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), run); });
}

/// Calls body(i) for the first i < count, like parallel_for, until stop() returns true, and returns how many: body was
/// called for each i below the result, and for no other one. Once stop() has returned true, it must always do so.
template <class Stop, class Body>
std::size_t parallel_until(std::size_t count, int threads, const Progress& progress, const Stop& stop, const Body& body)
{
    std::atomic<std::size_t> next{0};
    parallel_for(count, threads, progress, [&](std::size_t) {
        if (!stop()) body(next++);
    });
    return next;
}

/// Calls make(i, buffer) for each i < count, like parallel_for, and take(buffer) in the order of i, one at a time. A
/// result is taken while others are made, and its buffer is used again. If one result takes long, those after it wait
/// in memory.
template <class Buffer, class Make, class Take>
void parallel_in_order(std::size_t count, int threads, const Progress& progress, const Make& make, const Take& take)
{
    std::mutex mutex;
    std::size_t started = 0, taken = 0;
    std::map<std::size_t, Buffer> waiting;
    std::vector<Buffer> unused;
    parallel_for(count, threads, progress, [&](std::size_t) {
        Buffer buffer;
        std::unique_lock lock(mutex);
        const std::size_t i = started++;
        if (!unused.empty()) {
            buffer = std::move(unused.back());
            unused.pop_back();
        }
        lock.unlock();
        make(i, buffer);
        lock.lock();
        waiting.emplace(i, std::move(buffer));
        for (auto next = waiting.begin(); next != waiting.end() && next->first == taken; next = waiting.erase(next)) {
            take(next->second);
            unused.push_back(std::move(next->second));
            ++taken;
        }
    });
}

}  // namespace spawnfield
