// One way to use several cores: run(i) for every chunk i, chunks handed out in order to a pool of threads.
// Chunks are fixed by the caller and never depend on the number of threads, so results that are combined by
// chunk are equal to the last bit for any number of threads. Own pool of a few lines: ThreadSanitizer
// understands it, and it neither spins nor allocates while work is handed out.
#pragma once
#include <functional>

namespace loopwright {

// Threads used by parallel_chunks; 0 sets the number of processors (the default). Not to be changed while
// work runs.
void set_thread_count(int threads);
int thread_count();

// Calls run(0) .. run(chunks - 1), each once; returns when all are done. An exception from run is rethrown
// here (the one of the lowest chunk). Calls from inside run execute serially.
void parallel_chunks(int chunks, const std::function<void(int)>& run);

}  // namespace loopwright
