// Queries from their begin until all that counts for them has ended. A query adds up what the passes and dispatches
// between its begin and its end have counted, so that nobody has to wait for it: the last of them writes the result.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "runtime/raster/pass_targets.h"

namespace vernier {

class QueryPool;

/// One begun query; lives until its result is written.
struct RunningQuery {
    QueryPool* pool = nullptr;
    uint32_t query = 0;
    uint32_t views = 1;  // of the pass in which it began: it takes as many queries
    PassStatistics sum;
    uint32_t stream = 0;
    uint32_t parts = 0;  // work that has not ended, and 1 while it is open
};

/// Queries are begun and ended by one thread; parts end on any.
class RunningQueries {
  public:
    void begin(QueryPool& pool, uint32_t query, uint32_t views, uint32_t stream);
    /// The open query, which counts on until close(); nullptr where none is.
    RunningQuery* find(const QueryPool& pool, uint32_t query) const;
    void close(RunningQuery& query);
    /// Those that are open are forgotten: nobody will end them.
    void abandon();

    const std::vector<RunningQuery*>& open() const { return open_; }

    /// Work that counts for the query; partEnded() is called for it once.
    void addPart(RunningQuery& query);
    void partEnded(RunningQuery& query, const PassStatistics& counted);

  private:
    std::vector<RunningQuery*> open_;
    std::mutex mutex_;  // of what follows, and of the queries' sums and parts
    std::vector<std::unique_ptr<RunningQuery>> all_;
    std::vector<RunningQuery*> idle_;
};

}  // namespace vernier
