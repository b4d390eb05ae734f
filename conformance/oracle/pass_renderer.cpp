#include "conformance/oracle/pass_renderer.h"

#include "conformance/oracle/assembly.h"
#include "conformance/oracle/fragment_shader.h"
#include "conformance/oracle/pass_samples.h"
#include "conformance/oracle/prepare.h"
#include "conformance/oracle/quantise.h"
#include "conformance/oracle/sample_locations.h"
#include "conformance/oracle/sample_states.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>

namespace vernier::conformance::exact {

namespace {

/// In pixels: numbers of vertices that differ by less than this are snapped as one, but for ties.
constexpr double kLeastSnap = 0x1p-16;

class PassRenderer {
  public:
    /// `layer`: of the attachments' layers the one to render; `view`: whether it is a view, which gets every draw.
    PassRenderer(const Scene& scene, const ScenePass& pass, const OracleRules& rules, Memory& memory, uint32_t layer,
                 bool view)
        : scene_(scene),
          pass_(pass),
          rules_(rules),
          memory_(memory),
          target_(pass, memory.images, layer),
          layer_(layer),
          view_(view) {}

    Status run() {
        if (Status s = target_.load(); !s) return s;
        width_ = target_.width();
        height_ = target_.height();
        samples_ = target_.samples();
        for (const SceneDraw& draw : pass_.draws) {
            if (Status s = this->draw(draw); !s) return s;
        }
        target_.store();
        target_.resolve();
        return {};
    }

  private:
    Status draw(const SceneDraw& draw) {
        const ScenePipeline& pipeline = scene_.pipelines[draw.pipeline];
        OutputState output = target_.output();
        output.pipeline = &pipeline;
        ShaderResources vertexResources(scene_, memory_, draw, rules_);
        const uint32_t viewIndex = view_ ? layer_ : 0;
        auto geometry = assembleDraw(scene_, draw, vertexResources, viewIndex);
        if (!geometry) return geometry.error();
        if (Status s = checkVertexStage(vertexResources); !s) return s;
        std::optional<FragmentShader> shader;
        if (pipeline.fragmentShader != kNone) {
            auto created = FragmentShader::create(scene_, pipeline, viewIndex);
            if (!created) return created.error();
            shader = std::move(*created);
        }
        if (shader && shader->knowsVertices() && pipeline.polygonMode != VK_POLYGON_MODE_FILL)
            return unsupported("oracle: barycentric inputs of polygons drawn as lines or points");
        const PrepareContext context{draw,   pipeline,           {width_, height_},
                                     rules_, output.depthFormat, view_ ? std::nullopt : std::optional(layer_)};
        const Result<std::vector<PreparedPrimitive>> primitives = preparePrimitives(context, *geometry);
        if (!primitives) return primitives.error();
        positions_ = locations(pipeline);

        pixels_ = shadesCoarsely(pipeline, shader ? &*shader : nullptr) ? 2 : 1;

        // Each thread owns whole rows of quads and sees all triangles in order: the result does not depend on
        // threads.
        const uint32_t threads = std::clamp(std::thread::hardware_concurrency(), 1u, 16u);
        std::vector<Status> status(threads);
        std::vector<std::vector<TexelWrite>> writes(threads);
        WordTraffic words{vertexResources.wordWrites, vertexResources.loadedWords};
        std::mutex wordsInUse;
        std::vector<std::thread> workers;
        for (uint32_t t = 0; t < threads; ++t) {
            workers.emplace_back([&, t] {
                ShaderResources resources(scene_, memory_, draw, rules_);
                for (uint32_t row = t * rows(); row < height_ && status[t].ok(); row += threads * rows())
                    status[t] = shadeRows(*primitives, row, shader ? &*shader : nullptr, output, resources);
                writes[t] = std::move(resources.writes);
                if (status[t].ok()) status[t] = checkStores(pipeline, resources, writes[t]);
                const std::lock_guard lock(wordsInUse);
                words.writes.insert(words.writes.end(), resources.wordWrites.begin(), resources.wordWrites.end());
                words.loads.merge(resources.loadedWords);
            });
        }
        for (std::thread& worker : workers) worker.join();
        for (const Status& s : status) {
            if (!s) return s;
        }
        for (const std::vector<TexelWrite>& each : writes) {
            if (Status s = applyWrites(scene_, each, memory_); !s) return s;
        }
        for (const WordWrite& write : words.writes) {
            if (words.loads.contains({write.buffer, write.offset}))
                return unsupported("oracle: a draw that loads words of a buffer that it stores to");
        }
        return applyWords(scene_, words.writes, memory_);
    }

    struct WordTraffic {
        std::vector<WordWrite> writes;
        std::set<std::pair<uint32_t, uint64_t>> loads;
    };

    /// Vertex shaders run at least once for a vertex, and their inputs have no range.
    Status checkVertexStage(const ShaderResources& resources) const {
        if (!resources.refusal.empty()) return unsupported("oracle: " + resources.refusal);
        for (const WordWrite& write : resources.wordWrites) {
            if (!isIdempotent(write.op)) return unsupported("oracle: vertex shaders that count how often they run");
        }
        for (const auto& [buffer, offset] : resources.loadedWords) {
            const auto stored = memory_.buffers.find(buffer);
            if (stored == memory_.buffers.end()) continue;
            const auto open = stored->second.open.find(offset);
            if (open == stored->second.open.end()) continue;
            const Interval& value = open->second.value;
            if (open->second.flags != 0 || value.high - value.low > kLeastSnap)
                return unsupported("oracle: vertex shaders that load open words of a buffer");
        }
        return {};
    }

    /// Stores are modelled where every fragment makes them, and where nothing in the draw depends on their order.
    static Status checkStores(const ScenePipeline& pipeline, const ShaderResources& resources,
                              const std::vector<TexelWrite>& writes) {
        if (writes.empty() && resources.wordWrites.empty()) return {};
        if (pipeline.depthTest || pipeline.stencilTest || pipeline.depthBoundsTest)
            return unsupported("oracle: stores of fragments that tests may have dropped");
        for (const TexelWrite& write : writes) {
            for (const SceneBinding* read : resources.loads) {
                if (read->type == write.binding->type && read->image == write.binding->image &&
                    read->buffer == write.binding->buffer)
                    return unsupported("oracle: a draw that loads from what it stores to");
            }
        }
        return {};
    }

    /// Vulkan, Sample Shading: at least ceil(least * samples) fragments are shaded. Whether fewer than all may be.
    bool sharesFragments(const ScenePipeline& pipeline, const FragmentShader& shader) const {
        const float asked = pipeline.minSampleShading * static_cast<float>(samples_);
        return !shader.perSample() && asked <= static_cast<float>(samples_ - 1);
    }

    bool shadesSamples(const ScenePipeline& pipeline, const FragmentShader* shader) const {
        const bool asked = pipeline.sampleShading && pipeline.minSampleShading * static_cast<float>(samples_) > 1;
        return samples_ > 1 && shader && (asked || shader->perSample());
    }

    bool shadesCoarsely(const ScenePipeline& pipeline, const FragmentShader* shader) const {
        return rules_.coarseShading && samples_ == 1 && shader && shader->mayShadeCoarsely() &&
               !pipeline.alphaToCoverage && pipeline.lineMode != VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
    }

    std::vector<GridPoint> locations(const ScenePipeline& pipeline) const {
        if (pipeline.sampleLocations.empty()) return standardSampleLocations(samples_);
        std::vector<GridPoint> result;
        for (const auto& [x, y] : pipeline.sampleLocations) result.push_back({x, y});
        return result;
    }

    GridPoint samplePoint(int32_t x, int32_t y, uint32_t s) const {
        const int64_t unit = (int64_t{1} << rules_.subPixelBits) / 16;
        return {(int64_t{x} << rules_.subPixelBits) + positions_[s].x * unit,
                (int64_t{y} << rules_.subPixelBits) + positions_[s].y * unit};
    }

    /// Of pixels in a row of quads of fragments.
    uint32_t rows() const { return 2 * pixels_; }

    /// All primitives in their order, in the pixel rows of quads that begin at `row`.
    Status shadeRows(std::span<const PreparedPrimitive> primitives, uint32_t row, const FragmentShader* shader,
                     const OutputState& output, ShaderResources& resources) {
        for (size_t first = 0; first < primitives.size();) {
            size_t end = first + 1;
            const uint64_t outline = primitives[first].outline;
            while (end < primitives.size() && outline != 0 && primitives[end].outline == outline) ++end;
            const auto edges = primitives.subspan(first, end - first);
            if (Status s = shadeOutline(edges, row, shader, output, resources); !s) return s;
            first = end;
        }
        return {};
    }

    /// The edges or corners of one polygon. Vulkan, Rasterization Order, orders primitives, and they are one: what they
    /// leave in any of their orders is permitted.
    Status shadeOutline(std::span<const PreparedPrimitive> edges, uint32_t row, const FragmentShader* shader,
                        const OutputState& output, ShaderResources& resources) {
        std::vector<size_t> order;
        for (size_t i = 0; i < edges.size(); ++i) {
            const PixelBounds& bounds = edges[i].bounds;
            if (bounds.y0 < static_cast<int32_t>(row + rows()) && bounds.y1 > static_cast<int32_t>(row))
                order.push_back(i);
        }
        const auto shadeAll = [&]() -> Status {
            for (const size_t i : order) {
                if (Status s = shadeRow(edges[i], row, shader, output, resources); !s) return s;
            }
            return {};
        };
        if (order.size() < 2) return shadeAll();
        const size_t begin = static_cast<size_t>(row) * width_ * samples_;
        const size_t count = static_cast<size_t>(std::min(rows(), height_ - row)) * width_ * samples_;
        const std::span<Sample> rows = std::span(target_.all()).subspan(begin, count);
        const std::vector<Sample> before(rows.begin(), rows.end());
        std::vector<Sample> declared;
        do {
            std::ranges::copy(before, rows.begin());
            if (Status s = shadeAll(); !s) return s;
            for (size_t i = 0; i < count; ++i) {
                if (declared.size() < count) {
                    declared.push_back(rows[i]);
                } else {
                    addAlternatives(declared[i], rows[i], kOracleSequence);
                }
            }
        } while (std::ranges::next_permutation(order).found);
        std::ranges::move(declared, rows.begin());
        return {};
    }

    // The pixel rows of quads that begin at `row`: two of fragments.
    Status shadeRow(const PreparedPrimitive& t, uint32_t row, const FragmentShader* shader, const OutputState& output,
                    ShaderResources& resources) {
        const int32_t y0 = std::max<int32_t>(t.bounds.y0, static_cast<int32_t>(row));
        const auto step = static_cast<int32_t>(2 * pixels_);
        const int32_t y1 = std::min<int32_t>(t.bounds.y1, static_cast<int32_t>(row) + step);
        if (y0 >= y1) return {};
        std::vector<SampleVerdict> verdicts(4 * pixelsOfFragment() * samples_);
        for (int32_t qx = t.bounds.x0 & ~(step - 1); qx < t.bounds.x1; qx += step) {
            std::array<bool, 4> covered{};
            for (uint32_t lane = 0; lane < 4; ++lane) {
                for (uint32_t pixel = 0; pixel < pixelsOfFragment(); ++pixel) {
                    const auto [x, y] = pixelOf(qx, static_cast<int32_t>(row), lane, pixel);
                    for (uint32_t s = 0; s < samples_; ++s) {
                        SampleVerdict& verdict = verdicts[verdictIndex(lane, pixel, s)];
                        verdict = SampleVerdict{};
                        if (x < t.bounds.x0 || x >= t.bounds.x1 || y < y0 || y >= y1) continue;
                        if (!(output.pipeline->sampleMask & (1u << s))) continue;
                        verdict = t.classify(samplePoint(x, y, s));
                        covered[lane] = covered[lane] || verdict.possible;
                    }
                }
            }
            if (std::ranges::none_of(covered, [](bool c) { return c; })) continue;
            if (Status s = shadeQuad(t, qx, static_cast<int32_t>(row), covered, verdicts, shader, output, resources);
                !s) {
                return s;
            }
        }
        return {};
    }

    uint32_t pixelsOfFragment() const { return pixels_ * pixels_; }
    size_t verdictIndex(uint32_t lane, uint32_t pixel, uint32_t s) const {
        return (size_t{lane} * pixelsOfFragment() + pixel) * samples_ + s;
    }
    /// A pixel of a lane's fragment, in the quad whose first pixel is (qx, qy).
    std::pair<int32_t, int32_t> pixelOf(int32_t qx, int32_t qy, uint32_t lane, uint32_t pixel) const {
        return {qx + static_cast<int32_t>(lane % 2 * pixels_ + pixel % pixels_),
                qy + static_cast<int32_t>(lane / 2 * pixels_ + pixel / pixels_)};
    }

    Status shadeQuad(const PreparedPrimitive& t, int32_t qx, int32_t qy, const std::array<bool, 4>& covered,
                     const std::vector<SampleVerdict>& verdicts, const FragmentShader* shader,
                     const OutputState& output, ShaderResources& resources) {
        const bool perSample = shadesSamples(*output.pipeline, shader);
        std::vector<std::array<FragmentResult, 4>> runs(perSample ? samples_ : 1);
        for (uint32_t run = 0; run < runs.size(); ++run) {
            std::array<FragmentResult, 4>& fragments = runs[run];
            if (!shader) {
                for (FragmentResult& fragment : fragments) fragment.colorFlags.fill(kOracleUnknown);
                continue;
            }
            const ShadingPlace place = placeOf(t, qx, qy, verdicts, *shader, perSample, run);
            auto shaded = shader->evaluate(t.source, static_cast<uint32_t>(qx), static_cast<uint32_t>(qy), covered,
                                           output, resources, place);
            if (!shaded) return shaded.error();
            fragments = std::move(*shaded);
            for (size_t lane = 0; lane < 4; ++lane) {
                const auto all =
                    std::span(verdicts).subspan(lane * pixelsOfFragment() * samples_, pixelsOfFragment() * samples_);
                keepWrites(fragments[lane], perSample ? all.subspan(run, 1) : all, resources);
            }
        }
        if (perSample && sharesFragments(*output.pipeline, *shader)) {
            if (Status s = uniteRuns(runs); !s) return s;
        }
        for (uint32_t lane = 0; lane < 4; ++lane) {
            for (uint32_t pixel = 0; pixel < pixelsOfFragment(); ++pixel) {
                const auto [x, y] = pixelOf(qx, qy, lane, pixel);
                for (uint32_t s = 0; s < samples_; ++s) {
                    applySample(t, x, y, s, verdicts[verdictIndex(lane, pixel, s)], runs[perSample ? s : 0][lane],
                                output);
                }
            }
        }
        return {};
    }

    ShadingPlace placeOf(const PreparedPrimitive& t, int32_t qx, int32_t qy, const std::vector<SampleVerdict>& verdicts,
                         const FragmentShader& shader, bool perSample, uint32_t sample) const {
        ShadingPlace place;
        place.pixels = pixels_;
        if (pixels_ > 1) place.offset = {1, 1};
        if (perSample) {
            place.sample = sample;
            place.perSample = true;
            place.offset = {static_cast<double>(positions_[sample].x) / 16,
                            static_cast<double>(positions_[sample].y) / 16};
        } else if (shader.hasCentroids()) {
            for (size_t lane = 0; lane < 4; ++lane) {
                place.centroids[lane] =
                    centroidPlaces(t, qx + static_cast<int32_t>(lane % 2), qy + static_cast<int32_t>(lane / 2),
                                   std::span(verdicts).subspan(lane * samples_, samples_));
            }
        }
        return place;
    }

    /// What any sample of the pixel has is permitted at each: a fragment may stand for several, and its inputs and
    /// SampleId are those of any of them.
    static Status uniteRuns(std::vector<std::array<FragmentResult, 4>>& runs) {
        const std::vector<std::array<FragmentResult, 4>> each = runs;
        for (size_t s = 0; s < runs.size(); ++s) {
            for (size_t other = 0; other < runs.size(); ++other) {
                for (size_t lane = 0; lane < 4; ++lane) {
                    const FragmentResult& there = each[other][lane];
                    if (!there.writes.empty() || !there.wordWrites.empty())
                        return unsupported("oracle: stores of fragments that may stand for several samples");
                    if (s != other) runs[s][lane].unite(there);
                }
            }
        }
        return {};
    }

    static void keepWrites(const FragmentResult& fragment, std::span<const SampleVerdict> verdicts,
                           ShaderResources& resources) {
        const bool open = std::ranges::none_of(verdicts, &SampleVerdict::isCertain);
        for (TexelWrite write : fragment.writes) {
            write.open = open;
            resources.writes.push_back(write);
        }
        for (WordWrite write : fragment.wordWrites) {
            write.open = open;
            write.nominal = std::ranges::any_of(verdicts, &SampleVerdict::isNominal);
            resources.wordWrites.push_back(write);
        }
    }

    /// Where centroid inputs may be taken: at the centre when all samples are covered, else at any place of the pixel
    /// that the primitive covers (Vulkan, Interpolation Decorations). The declared one comes first.
    std::vector<std::array<double, 2>> centroidPlaces(const PreparedPrimitive& t, int32_t x, int32_t y,
                                                      std::span<const SampleVerdict> verdicts) const {
        const std::array<double, 2> centre{x + 0.5, y + 0.5};
        if (std::ranges::all_of(verdicts, [](const SampleVerdict& v) { return v.isCertain(); })) return {centre};
        std::vector<std::array<double, 2>> places;
        for (uint32_t s = 0; s < samples_; ++s) {
            if (verdicts[s].possible) {
                places.push_back(
                    {x + static_cast<double>(positions_[s].x) / 16, y + static_cast<double>(positions_[s].y) / 16});
            }
        }
        for (const auto& corner : t.clippedPixel(x, y)) places.push_back(corner);
        // An edge sample may leave all of them covered.
        if (std::ranges::all_of(verdicts, &SampleVerdict::possible)) places.push_back(centre);
        return places;
    }

    void applySample(const PreparedPrimitive& t, int32_t x, int32_t y, uint32_t s, const SampleVerdict& verdict,
                     const FragmentResult& shaded, const OutputState& output) {
        if (!verdict.possible) return;
        const ScenePipeline& pipeline = *output.pipeline;
        SampleInput input;
        input.verdict = verdict;
        FragmentResult fragment = shaded;
        const GridPoint point = samplePoint(x, y, s);
        if (const auto coverage = t.smoothCoverage(point)) {
            for (Color& color : fragment.colors) {
                color[3] = {color[3].value * *coverage, std::min(0.0, color[3].low), std::max(0.0, color[3].high)};
            }
        }
        if (pipeline.alphaToCoverage && samples_ > 1) {
            const Interval& alpha = fragment.colors[0][3];
            if (alpha.high <= 0) return;
            input.coverageOpen = alpha.low < 1 - kCodeTolerance;
        }
        if (pipeline.alphaToOne && samples_ > 1) {
            for (Color& color : fragment.colors) color[3] = 1.0;
        }
        input.fragment = &fragment;
        GridPoint depthPoint = point;
        if (rules_.mirroredDepths) {
            const int64_t unit = int64_t{1} << rules_.subPixelBits;
            depthPoint.x = (2 * int64_t{x} + 1) * unit - point.x;
        }
        input.depth = t.carrier.depth(depthPoint) + t.bias;
        // Without depth clamping fragments beyond the viewport's range have been clipped; rounding leaves no
        // more than a trace.
        const auto [low, high] = std::minmax(t.viewport.minDepth, t.viewport.maxDepth);
        if (pipeline.depthClip.value_or(!pipeline.depthClamp) && !pipeline.depthBias)
            input.depth = input.depth.clamped(low, high);
        input.depthOrigin = t.depthOrigin;
        input.frontFacing = t.source.frontFacing;
        input.viewport = t.viewport;
        applyTriangle(output, input, target_.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y), s));
    }

    const Scene& scene_;
    const ScenePass& pass_;
    const OracleRules& rules_;
    Memory& memory_;
    PassSamples target_;
    const uint32_t layer_;
    const bool view_;
    uint32_t width_ = 0, height_ = 0, samples_ = 1;
    std::vector<GridPoint> positions_;
    uint32_t pixels_ = 1;  // on a side of a fragment of the draw
};

}  // namespace

Status renderPass(const Scene& scene, const ScenePass& pass, const OracleRules& rules, Memory& memory) {
    uint32_t layers = pass.depthStencil.image != kNone ? pass.depthStencil.layerCount : ~0u;
    for (const SceneAttachment& color : pass.colors) layers = std::min(layers, color.layerCount);
    if (layers == ~0u) layers = 1;
    for (uint32_t layer = 0; layer < layers; ++layer) {
        const bool view = pass.viewMask != 0;
        if (view && (pass.viewMask >> layer & 1) == 0) continue;
        if (Status s = PassRenderer(scene, pass, rules, memory, layer, view).run(); !s) return s;
    }
    return {};
}

}  // namespace vernier::conformance::exact
