#include "runtime/command/running_queries.h"

#include <algorithm>
#include <functional>

#include "runtime/command/query_pool.h"

namespace vernier {

void RunningQueries::begin(QueryPool& pool, uint32_t query, uint32_t views, uint32_t stream) {
    open_.reserve(open_.size() + 1);
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) {
        idle_.reserve(all_.size() + 1);  // parts must find room when they end
        all_.push_back(std::make_unique<RunningQuery>());
        idle_.push_back(all_.back().get());
    }
    RunningQuery& run = *idle_.back();
    idle_.pop_back();
    run = {&pool, query, views, {}, stream, 1};
    pool.hold();
    open_.push_back(&run);
}

RunningQuery* RunningQueries::find(const QueryPool& pool, uint32_t query) const {
    const auto found = std::find_if(open_.begin(), open_.end(),
                                    [&](const RunningQuery* run) { return run->pool == &pool && run->query == query; });
    return found == open_.end() ? nullptr : *found;
}

void RunningQueries::close(RunningQuery& query) {
    open_.erase(std::find(open_.begin(), open_.end(), &query));
    partEnded(query, {});
}

void RunningQueries::abandon() {
    const std::lock_guard lock(mutex_);
    for (RunningQuery* run : open_) run->pool->release();
    open_.clear();  // their places stay taken: parts of them may still end
}

void RunningQueries::addPart(RunningQuery& query) {
    const std::lock_guard lock(mutex_);
    ++query.parts;
}

void RunningQueries::partEnded(RunningQuery& query, const PassStatistics& counted) {
    const std::lock_guard lock(mutex_);
    query.sum = combine(query.sum, counted, std::plus<>{});
    if (--query.parts != 0) return;
    query.pool->write(query.query, query.sum, query.stream);
    // With multiview a query takes as many as there are views: "the first contains the result, the others zero".
    for (uint32_t n = 1; n < query.views; ++n) query.pool->write(query.query + n, {});
    query.pool->release();
    idle_.push_back(&query);
}

}  // namespace vernier
