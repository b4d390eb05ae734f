#include "conformance/oracle/pass_renderer.h"

#include "conformance/oracle/assembly.h"
#include "conformance/oracle/fragment_shader.h"
#include "conformance/oracle/prepare.h"
#include "conformance/oracle/quantise.h"
#include "conformance/oracle/sample_locations.h"
#include "conformance/oracle/sample_states.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <thread>

namespace vernier::conformance::exact {

namespace {

class PassRenderer {
  public:
    /// `layer`: of the attachments' layers the one to render; `view`: whether it is a view, which gets every draw.
    PassRenderer(const Scene& scene, const ScenePass& pass, const OracleRules& rules, Memory& memory, uint32_t layer,
                 bool view)
        : scene_(scene),
          pass_(pass),
          rules_(rules),
          memory_(memory),
          images_(memory.images),
          layer_(layer),
          view_(view) {}

    Status run() {
        if (Status s = load(); !s) return s;
        for (const SceneDraw& draw : pass_.draws) {
            if (Status s = this->draw(draw); !s) return s;
        }
        store();
        resolve();
        return {};
    }

  private:
    ImageLevel* attachment(const SceneAttachment& a) {
        return a.image < images_.size() ? &images_[a.image].level(a.mipLevel, a.layer + layer_) : nullptr;
    }

    Status load() {
        if (pass_.colors.size() > kMaxColorAttachments) {
            return unsupported("oracle: a pass with " + std::to_string(pass_.colors.size()) + " colour attachments");
        }
        width_ = pass_.extent.width;
        height_ = pass_.extent.height;
        output_.colorCount = pass_.colors.size();
        const ImageLevel* depth = attachment(pass_.depthStencil);
        for (size_t i = 0; i < pass_.colors.size(); ++i) {
            if (const ImageLevel* color = attachment(pass_.colors[i])) {
                samples_ = color->samples;
                output_.colorFormats[i] = &images_[pass_.colors[i].image].format();
            }
        }
        if (depth) {
            samples_ = depth->samples;
            output_.depthFormat = &images_[pass_.depthStencil.image].format();
        }
        positions_ = standardSampleLocations(samples_);
        if (positions_.empty()) return unsupported("oracle: " + std::to_string(samples_) + " samples");
        state_.resize(static_cast<size_t>(width_) * height_ * samples_);
        for (uint32_t y = 0; y < height_; ++y) {
            for (uint32_t x = 0; x < width_; ++x) {
                for (uint32_t s = 0; s < samples_; ++s) at(x, y, s) = loadStates(x, y, s);
            }
        }
        return {};
    }

    /// A loaded stencil that may hold several codes is each of them in turn; the operations on it are on codes.
    Sample loadStates(uint32_t x, uint32_t y, uint32_t s) {
        Sample states{loadSample(x, y, s)};
        const SceneAttachment& a = pass_.depthStencil;
        if (!output_.depthFormat || !output_.depthFormat->stencil || a.loadOp != VK_ATTACHMENT_LOAD_OP_LOAD)
            return states;
        const StoredTexel& texel = attachment(a)->at(x, y, s);
        constexpr OracleFlags kReasons = kOracleTie | kOracleSnap | kOracleOrder | kOraclePattern | kOracleSequence;
        for (double code = texel.channels[1].low; code <= texel.channels[1].high; ++code) {
            SampleState other = states[0];
            other.stencil = static_cast<uint8_t>(code);
            addAlternatives(states, {other}, texel.flags & kReasons);
        }
        return states;
    }

    SampleState loadSample(uint32_t x, uint32_t y, uint32_t s) {
        SampleState state;
        for (size_t i = 0; i < pass_.colors.size(); ++i) {
            const SceneAttachment& a = pass_.colors[i];
            if (!output_.colorFormats[i]) continue;
            const PixelFormat& format = *output_.colorFormats[i];
            if (a.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) {
                Color clear;
                for (size_t c = 0; c < 4; ++c) {
                    const bool isSigned = format.components[0].encoding == Encoding::sint;
                    clear[c] = !format.isInteger() ? static_cast<double>(a.clear.color.float32[c])
                               : isSigned          ? static_cast<double>(a.clear.color.int32[c])
                                                   : static_cast<double>(a.clear.color.uint32[c]);
                }
                state.colors[i] = quantiseColor(format, clear);
            } else {
                const StoredTexel& texel = attachment(a)->at(x, y, s);
                state.colors[i] = texel.channels;
                state.flags[i] = a.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD ? texel.flags : OracleFlags{kOracleUnknown};
            }
        }
        if (output_.depthFormat) {
            const SceneAttachment& a = pass_.depthStencil;
            if (a.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) {
                state.depth = static_cast<double>(a.clear.depthStencil.depth);
                if (output_.depthFormat->depth) state.depth = quantise(output_.depthFormat->components[0], state.depth);
                state.stencil = static_cast<uint8_t>(a.clear.depthStencil.stencil);
            } else {
                const StoredTexel& texel = attachment(a)->at(x, y, s);
                state.depth = texel.channels[0];
                state.stencil = static_cast<uint8_t>(texel.channels[1].value);
                state.flags[kDepthFlags] =
                    a.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD ? texel.flags : OracleFlags{kOracleUnknown};
            }
        }
        return state;
    }

    Sample& at(uint32_t x, uint32_t y, uint32_t s) {
        return state_[(static_cast<size_t>(y) * width_ + x) * samples_ + s];
    }

    Status draw(const SceneDraw& draw) {
        const ScenePipeline& pipeline = scene_.pipelines[draw.pipeline];
        if (Status s = checkModelled(pipeline); !s) return s;
        OutputState output = output_;
        output.pipeline = &pipeline;
        ShaderResources vertexResources(scene_, memory_, draw, rules_);
        const uint32_t viewIndex = view_ ? layer_ : 0;
        auto geometry = assembleDraw(scene_, draw, vertexResources, viewIndex);
        if (!geometry) return geometry.error();
        if (vertexResources.wrote) return unsupported("oracle: the vertex shader uses storage buffers or images");
        std::optional<FragmentShader> shader;
        if (pipeline.fragmentShader != kNone) {
            auto created = FragmentShader::create(scene_, pipeline, viewIndex);
            if (!created) return created.error();
            shader = std::move(*created);
        }
        const PrepareContext context{draw,
                                     pipeline,
                                     {width_, height_},
                                     rules_.subPixelBits,
                                     output_.depthFormat,
                                     view_ ? std::nullopt : std::optional(layer_),
                                     rules_.majorAxisLines,
                                     rules_.planesBehindEye};
        const Result<std::vector<PreparedPrimitive>> primitives = preparePrimitives(context, *geometry);
        if (!primitives) return primitives.error();
        positions_ = locations(pipeline);

        pixels_ = shadesCoarsely(pipeline, shader ? &*shader : nullptr) ? 2 : 1;

        // Each thread owns whole rows of quads and sees all triangles in order: the result does not depend on
        // threads.
        const uint32_t threads = std::clamp(std::thread::hardware_concurrency(), 1u, 16u);
        std::vector<Status> status(threads);
        std::vector<std::vector<TexelWrite>> writes(threads);
        std::vector<std::thread> workers;
        for (uint32_t t = 0; t < threads; ++t) {
            workers.emplace_back([&, t] {
                ShaderResources resources(scene_, memory_, draw, rules_);
                for (uint32_t row = t * rows(); row < height_ && status[t].ok(); row += threads * rows())
                    status[t] = shadeRows(*primitives, row, shader ? &*shader : nullptr, output, resources);
                writes[t] = std::move(resources.writes);
                if (status[t].ok() && !writes[t].empty()) status[t] = checkStores(pipeline, resources);
            });
        }
        for (std::thread& worker : workers) worker.join();
        for (const Status& s : status) {
            if (!s) return s;
        }
        for (const std::vector<TexelWrite>& each : writes) {
            if (Status s = applyWrites(scene_, each, memory_); !s) return s;
        }
        return {};
    }

    /// Stores are modelled where every fragment makes them, and where nothing in the draw depends on their order.
    static Status checkStores(const ScenePipeline& pipeline, const ShaderResources& resources) {
        if (pipeline.depthTest || pipeline.stencilTest || pipeline.depthBoundsTest)
            return unsupported("oracle: stores of fragments that tests may have dropped");
        for (const TexelWrite& write : resources.writes) {
            for (const SceneBinding* read : resources.loads) {
                if (read->type == write.binding->type && read->image == write.binding->image &&
                    read->buffer == write.binding->buffer)
                    return unsupported("oracle: a draw that loads from what it stores to");
            }
        }
        return {};
    }

    Status checkModelled(const ScenePipeline& pipeline) const {
        // Vulkan, Sample Shading: at least ceil(least * samples) fragments are shaded; all or one are modelled.
        const float asked = pipeline.minSampleShading * static_cast<float>(samples_);
        if (pipeline.sampleShading && asked > 1 && asked <= static_cast<float>(samples_ - 1)) {
            return unsupported("oracle: shading of some samples");
        }
        return {};
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
        const std::vector<Sample> before(state_.begin() + static_cast<ptrdiff_t>(begin),
                                         state_.begin() + static_cast<ptrdiff_t>(begin + count));
        std::vector<Sample> declared;
        do {
            std::copy(before.begin(), before.end(), state_.begin() + static_cast<ptrdiff_t>(begin));
            if (Status s = shadeAll(); !s) return s;
            for (size_t i = 0; i < count; ++i) {
                if (declared.size() < count) {
                    declared.push_back(state_[begin + i]);
                } else {
                    addAlternatives(declared[i], state_[begin + i], kOracleSequence);
                }
            }
        } while (std::ranges::next_permutation(order).found);
        std::ranges::move(declared, state_.begin() + static_cast<ptrdiff_t>(begin));
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
        for (uint32_t run = 0; run < (perSample ? samples_ : 1); ++run) {
            std::array<FragmentResult, 4> fragments{};
            if (shader) {
                ShadingPlace place;
                place.pixels = pixels_;
                if (pixels_ > 1) place.offset = {1, 1};
                if (perSample) {
                    place.sample = run;
                    place.perSample = true;
                    place.offset = {static_cast<double>(positions_[run].x) / 16,
                                    static_cast<double>(positions_[run].y) / 16};
                } else if (shader->hasCentroids()) {
                    for (size_t lane = 0; lane < 4; ++lane) {
                        place.centroids[lane] =
                            centroidPlaces(t, qx + static_cast<int32_t>(lane % 2), qy + static_cast<int32_t>(lane / 2),
                                           std::span(verdicts).subspan(lane * samples_, samples_));
                    }
                }
                auto shaded = shader->evaluate(t.source, static_cast<uint32_t>(qx), static_cast<uint32_t>(qy), covered,
                                               output, resources, place);
                if (!shaded) return shaded.error();
                fragments = std::move(*shaded);
                for (size_t lane = 0; lane < 4; ++lane)
                    keepWrites(fragments[lane], std::span(verdicts).subspan(lane * samples_, samples_), resources);
            } else {
                for (FragmentResult& fragment : fragments) fragment.colorFlags.fill(kOracleUnknown);
            }
            for (uint32_t lane = 0; lane < 4; ++lane) {
                for (uint32_t pixel = 0; pixel < pixelsOfFragment(); ++pixel) {
                    const auto [x, y] = pixelOf(qx, qy, lane, pixel);
                    for (uint32_t s = 0; s < samples_; ++s) {
                        if (perSample && s != run) continue;
                        applySample(t, x, y, s, verdicts[verdictIndex(lane, pixel, s)], fragments[lane], output);
                    }
                }
            }
        }
        return {};
    }

    static void keepWrites(const FragmentResult& fragment, std::span<const SampleVerdict> verdicts,
                           ShaderResources& resources) {
        for (TexelWrite write : fragment.writes) {
            write.open = std::ranges::none_of(verdicts, [](const SampleVerdict& v) { return v.isCertain(); });
            resources.writes.push_back(write);
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
        applyTriangle(output, input, at(static_cast<uint32_t>(x), static_cast<uint32_t>(y), s));
    }

    void store() {
        for (uint32_t y = 0; y < height_; ++y) {
            for (uint32_t x = 0; x < width_; ++x) {
                for (uint32_t s = 0; s < samples_; ++s) storeSample(x, y, s);
            }
        }
    }

    void storeSample(uint32_t x, uint32_t y, uint32_t s) {
        const Sample& states = at(x, y, s);
        for (size_t i = 0; i < pass_.colors.size(); ++i) {
            ImageLevel* target = attachment(pass_.colors[i]);
            if (!target) continue;
            StoredTexel texel{states[0].colors[i], states[0].flags[i]};
            for (const SampleState& state : states) {
                texel.flags |= state.flags[i];
                if (state.colors[i] != states[0].colors[i]) texel.flags |= kOracleEdge;
                for (size_t c = 0; c < 4; ++c) texel.channels[c] = texel.channels[c].united(state.colors[i][c]);
            }
            target->at(x, y, s) = texel;
        }
        if (ImageLevel* target = attachment(pass_.depthStencil)) {
            StoredTexel texel{{states[0].depth, static_cast<double>(states[0].stencil), 0.0, 1.0},
                              states[0].flags[kDepthFlags]};
            for (const SampleState& state : states) {
                texel.flags |= state.flags[kDepthFlags];
                const Interval stencil(state.stencil);
                if (state.depth != states[0].depth || state.stencil != states[0].stencil) texel.flags |= kOracleEdge;
                texel.channels[0] = texel.channels[0].united(state.depth);
                texel.channels[1] = texel.channels[1].united(stencil);
            }
            target->at(x, y, s) = texel;
        }
    }

    void resolve() {
        for (const SceneAttachment& a : pass_.colors) {
            if (a.resolveImage >= images_.size()) continue;
            const ImageLevel& source = images_[a.image].level(a.mipLevel, a.layer + layer_);
            ImageLevel& target = images_[a.resolveImage].level(0, layer_);
            for (uint32_t y = 0; y < height_; ++y) {
                for (uint32_t x = 0; x < width_; ++x) {
                    target.at(x, y) = resolveSamples(images_[a.image].format(), source, x, y);
                }
            }
        }
        const SceneAttachment& depth = pass_.depthStencil;
        if (depth.image >= images_.size() || depth.resolveImage >= images_.size()) return;
        const ImageLevel& source = images_[depth.image].level(depth.mipLevel, depth.layer + layer_);
        ImageLevel& target = images_[depth.resolveImage].level(0, layer_);
        for (uint32_t y = 0; y < height_; ++y) {
            for (uint32_t x = 0; x < width_; ++x) {
                target.at(x, y) = resolveDepthStencil(images_[depth.image].format(), source, x, y, depth.depthResolve,
                                                      depth.stencilResolve);
            }
        }
    }

    const Scene& scene_;
    const ScenePass& pass_;
    const OracleRules& rules_;
    Memory& memory_;
    std::vector<ImageStore>& images_;
    const uint32_t layer_;
    const bool view_;
    uint32_t width_ = 0, height_ = 0, samples_ = 1;
    OutputState output_;  // attachments only
    std::vector<GridPoint> positions_;
    uint32_t pixels_ = 1;  // on a side of a fragment of the draw
    std::vector<Sample> state_;
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
