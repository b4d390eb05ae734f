// Queries.
#include <algorithm>
#include <array>

#include "api/mini/context_guard.h"

using namespace vernier;
using namespace vernier::mini;

namespace {

/// The fields of VnQueryResult from inputVertices on, which come in the order of these bits.
constexpr VkQueryPipelineStatisticFlags kStatistics =
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT | VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT | VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
constexpr size_t kStatisticCount = 11;

VkQueryType typeOf(VnQueryType type) {
    return type == VN_QUERY_OCCLUSION    ? VK_QUERY_TYPE_OCCLUSION
           : type == VN_QUERY_STATISTICS ? VK_QUERY_TYPE_PIPELINE_STATISTICS
                                         : VK_QUERY_TYPE_TIMESTAMP;
}

VnResult findQuery(VnContext context, const char* function, VnQuery handle, std::shared_ptr<QueryObject>& query) {
    query = context->device->queries.find(handle.id);
    return query ? VN_SUCCESS : badHandle(context->device, function, "query");
}

auto findActive(VnContext context, const std::shared_ptr<QueryObject>& query) {
    return std::find_if(context->queries.begin(), context->queries.end(),
                        [&](const VnContext_T::ActiveQuery& active) { return active.query == query; });
}

}  // namespace

QueryObject::QueryObject(VnQueryType queryType) : type(queryType), pool(typeOf(queryType), 1, kStatistics) {}

VnResult vnCreateQuery(VnDevice device, VnQueryType type, VnQuery* query) {
    return guarded(device, __func__, [&] {
        if (!query) return invalid(device, "vnCreateQuery", "the place for the handle is NULL");
        if (VnResult r = checkEnum(device, "vnCreateQuery", "type", type, VN_QUERY_TIMESTAMP)) return r;
        query->id = device->queries.insert(std::make_shared<QueryObject>(type));
        return VN_SUCCESS;
    });
}

VnResult vnDestroyQuery(VnDevice device, VnQuery query) {
    return destroyIn(device, "vnDestroyQuery", "query", device->queries, query.id);
}

VnResult vnBeginQuery(VnContext context, VnQuery query) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<QueryObject> object;
        if (VnResult result = findQuery(context, "vnBeginQuery", query, object)) return result;
        if (object->type == VN_QUERY_TIMESTAMP)
            return invalid(context->device, "vnBeginQuery", "a timestamp is written, not begun");
        if (findActive(context, object) != context->queries.end())
            return wrongState(context, "vnBeginQuery", "the query has begun already");
        context->recording->keep(object);
        QueryPool* pool = &object->pool;
        context->queries.push_back({object, context->inPass});
        context->recording->commands.record(command::ResetQueries{pool, 0, 1});
        context->recording->commands.record(command::BeginQuery{pool, 0});
        return VN_SUCCESS;
    });
}

VnResult vnEndQuery(VnContext context, VnQuery query) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<QueryObject> object;
        if (VnResult result = findQuery(context, "vnEndQuery", query, object)) return result;
        const auto active = findActive(context, object);
        if (active == context->queries.end()) return wrongState(context, "vnEndQuery", "the query has not begun");
        if (active->inPass != context->inPass)
            return wrongState(context, "vnEndQuery", "the query has begun outside the pass that is open");
        context->recording->commands.record(command::EndQuery{&object->pool, 0});
        context->queries.erase(active);
        return VN_SUCCESS;
    });
}

VnResult vnWriteTimestamp(VnContext context, VnQuery query) {
    return guardedContext(context, __func__, [&] {
        std::shared_ptr<QueryObject> object;
        if (VnResult result = findQuery(context, "vnWriteTimestamp", query, object)) return result;
        if (object->type != VN_QUERY_TIMESTAMP)
            return invalid(context->device, "vnWriteTimestamp", "the query is not a timestamp");
        context->recording->keep(object);
        context->recording->commands.record(command::WriteTimestamp{&object->pool, 0});
        return VN_SUCCESS;
    });
}

VnResult vnGetQueryResult(VnContext context, VnQuery query, VnQueryResult* result) {
    return guardedContext(context, __func__, [&] {
        if (!result) return invalid(context->device, "vnGetQueryResult", "result is NULL");
        std::shared_ptr<QueryObject> object;
        if (VnResult failure = findQuery(context, "vnGetQueryResult", query, object)) return failure;
        if (VnResult failure = finish(context, "vnGetQueryResult")) return failure;
        std::array<uint64_t, kStatisticCount> values{};
        if (object->pool.results(0, 1, reinterpret_cast<std::byte*>(values.data()), sizeof values, sizeof values,
                                 VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
            return wrongState(context, "vnGetQueryResult", "the query was never ended or written");
        *result = {};
        if (object->type != VN_QUERY_STATISTICS) {
            result->value = values[0];
            return VN_SUCCESS;
        }
        // In the order of their bits.
        uint64_t* const fields[kStatisticCount] = {
            &result->inputVertices,         &result->inputPrimitives,     &result->vertexInvocations,
            &result->geometryInvocations,   &result->geometryPrimitives,  &result->clippingInvocations,
            &result->clippingPrimitives,    &result->fragmentInvocations, &result->controlPatches,
            &result->evaluationInvocations, &result->computeInvocations};
        for (size_t n = 0; n < kStatisticCount; ++n) *fields[n] = values[n];
        return VN_SUCCESS;
    });
}
