#include "conformance/oracle/pass_renderer.h"

#include "conformance/oracle/assembly.h"
#include "conformance/oracle/depth_exact.h"
#include "conformance/oracle/fragment_shader.h"
#include "conformance/oracle/quantise.h"
#include "conformance/oracle/sample_locations.h"
#include "conformance/oracle/sample_states.h"
#include "conformance/oracle/triangle.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <thread>

namespace vernier::conformance::exact {

namespace {

// One triangle ready for all rows.
struct PreparedTriangle {
    Triangle triangle;
    FragmentSource source;
    PixelBounds bounds;
    Interval bias;  // of depth
    uint64_t depthOrigin = 0;
    bool culled = false;  // nominally; only kept if another orientation is legal
};

class PassRenderer {
  public:
    PassRenderer(const Scene& scene, const ScenePass& pass, const OracleRules& rules, std::vector<ImageStore>& images)
        : scene_(scene), pass_(pass), rules_(rules), images_(images) {}

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
        return a.image < images_.size() ? &images_[a.image].level(a.mipLevel, a.layer) : nullptr;
    }

    Status load() {
        if (pass_.colors.size() > kMaxColorAttachments) {
            return unsupported("oracle: a pass with " + std::to_string(pass_.colors.size()) + " colour attachments");
        }
        if (pass_.viewMask != 0) return unsupported("oracle: multiview");
        for (const SceneAttachment& color : pass_.colors)
            if (color.layerCount != 1) return unsupported("oracle: layered rendering");
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
                for (uint32_t s = 0; s < samples_; ++s) at(x, y, s) = {loadSample(x, y, s)};
            }
        }
        return {};
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
                state.flags[i] = a.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD ? texel.flags : uint8_t{kOracleUnknown};
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
                    a.loadOp == VK_ATTACHMENT_LOAD_OP_LOAD ? texel.flags : uint8_t{kOracleUnknown};
            }
        }
        return state;
    }

    Sample& at(uint32_t x, uint32_t y, uint32_t s) {
        return state_[(static_cast<size_t>(y) * width_ + x) * samples_ + s];
    }

    Status draw(const SceneDraw& draw) {
        const ScenePipeline& pipeline = scene_.pipelines[draw.pipeline];
        if (Status s = checkModelled(draw, pipeline); !s) return s;
        OutputState output = output_;
        output.pipeline = &pipeline;
        output.viewport = draw.viewport;
        ShaderResources vertexResources(scene_, images_, draw);
        auto geometry = assembleDraw(scene_, draw, vertexResources);
        if (!geometry) return geometry.error();
        if (vertexResources.wrote) return unsupported("oracle: the vertex shader uses storage buffers or images");
        std::optional<FragmentShader> shader;
        if (pipeline.fragmentShader != kNone) {
            auto created = FragmentShader::create(scene_, pipeline);
            if (!created) return created.error();
            shader = std::move(*created);
        }
        const std::vector<PreparedTriangle> triangles = prepare(draw, pipeline, *geometry);

        // Each thread owns whole rows of quads and sees all triangles in order: the result does not depend on
        // threads.
        const uint32_t threads = std::clamp(std::thread::hardware_concurrency(), 1u, 16u);
        std::vector<Status> status(threads);
        std::vector<std::thread> workers;
        for (uint32_t t = 0; t < threads; ++t) {
            workers.emplace_back([&, t] {
                ShaderResources resources(scene_, images_, draw);
                for (uint32_t row = t * 2; row < height_ && status[t].ok(); row += threads * 2) {
                    for (const PreparedTriangle& triangle : triangles) {
                        status[t] = shadeRow(triangle, row, shader ? &*shader : nullptr, output, resources);
                        if (!status[t]) break;
                    }
                }
            });
        }
        for (std::thread& worker : workers) worker.join();
        for (const Status& s : status) {
            if (!s) return s;
        }
        return {};
    }

    Status checkModelled(const SceneDraw& draw, const ScenePipeline& pipeline) const {
        if (pipeline.polygonMode != VK_POLYGON_MODE_FILL) return unsupported("oracle: polygonMode other than FILL");
        if (pipeline.logicOpEnable) return unsupported("oracle: logic operations");
        if (pipeline.depthBoundsTest) return unsupported("oracle: the depth bounds test");
        if (pipeline.sampleShading && samples_ > 1) return unsupported("oracle: shading of samples");
        if (!pipeline.sampleLocations.empty()) return unsupported("oracle: sample locations");
        if (!draw.moreViews.empty()) return unsupported("oracle: several viewports");
        if (pipeline.alphaToOne) return unsupported("oracle: alpha to one");
        for (const SceneBinding& binding : draw.bindings)
            if (binding.sampler != kNone && scene_.samplers[binding.sampler].maxAnisotropy > 1)
                return unsupported("oracle: anisotropic filtering");
        return {};
    }

    std::vector<PreparedTriangle> prepare(const SceneDraw& draw, const ScenePipeline& pipeline,
                                          const DrawGeometry& geometry) {
        const VkRect2D& scissor = draw.scissor;
        PixelBounds limits{
            std::max(0, scissor.offset.x), std::max(0, scissor.offset.y),
            static_cast<int32_t>(std::min<int64_t>(width_, int64_t{scissor.offset.x} + scissor.extent.width)),
            static_cast<int32_t>(std::min<int64_t>(height_, int64_t{scissor.offset.y} + scissor.extent.height))};
        const double context[] = {static_cast<double>(pipeline.vertexShader),
                                  draw.viewport.x,
                                  draw.viewport.y,
                                  draw.viewport.width,
                                  draw.viewport.height,
                                  draw.viewport.minDepth,
                                  draw.viewport.maxDepth};
        std::vector<PreparedTriangle> result;
        for (size_t i = 0; i < geometry.triangles.size(); ++i) {
            FragmentSource source;
            Triangle::Setup setup{{},
                                  draw.viewport,
                                  !pipeline.depthClamp,
                                  {},
                                  hashNumbers(0, context, std::size(context)),
                                  rules_.subPixelBits};
            size_t distances = ~size_t{0};
            for (size_t k = 0; k < 3; ++k) {
                source.vertices[k] = &geometry.vertices[geometry.triangles[i][k]];
                setup.position[k] = source.vertices[k]->position;
                distances = std::min(distances, source.vertices[k]->clipDistances.size());
            }
            for (size_t d = 0; d < distances; ++d) {
                std::array<double, 3> cut;
                for (size_t k = 0; k < 3; ++k) cut[k] = source.vertices[k]->clipDistances[d];
                setup.clipDistances.push_back(cut);
            }
            auto triangle = Triangle::create(setup);
            if (!triangle) continue;
            const PixelBounds bounds = triangle->bounds(limits);
            if (bounds.empty()) continue;
            source.frontFacing = isFrontFacing(triangle->orientation(), pipeline.frontFace);
            source.primitiveId = geometry.primitiveIds[i];
            const bool culled = (source.frontFacing && (pipeline.cullMode & VK_CULL_MODE_FRONT_BIT)) ||
                                (!source.frontFacing && (pipeline.cullMode & VK_CULL_MODE_BACK_BIT));
            if (culled && (!triangle->orientationOpen() || pipeline.cullMode == VK_CULL_MODE_FRONT_AND_BACK)) continue;
            PreparedTriangle prepared{std::move(*triangle), source, bounds, 0.0, 0, culled};
            prepared.depthOrigin = prepared.triangle.identity();
            if (pipeline.depthBias && output_.depthFormat) {
                prepared.bias = biasOf(prepared.triangle, pipeline);
                const double bias[] = {pipeline.depthBiasConstant, pipeline.depthBiasClamp, pipeline.depthBiasSlope};
                prepared.depthOrigin = hashNumbers(prepared.depthOrigin, bias, 3);
            }
            result.push_back(std::move(prepared));
        }
        for (PreparedTriangle& p : result) p.source.triangle = &p.triangle;
        return result;
    }

    Interval biasOf(const Triangle& triangle, const ScenePipeline& pipeline) const {
        std::array<Rational, 3> depths;
        const std::array<double, 3> z = triangle.vertexDepths();
        for (size_t i = 0; i < 3; ++i) depths[i] = rational(std::isfinite(z[i]) ? z[i] : 1.0);
        const BiasRange range = depthBias(output_.depthFormat->format, depths, rational(triangle.depthSlopeX()),
                                          rational(triangle.depthSlopeY()), pipeline.depthBiasConstant,
                                          pipeline.depthBiasClamp, pipeline.depthBiasSlope);
        return {(range.low + range.high) / 2, range.low, range.high};
    }

    GridPoint samplePoint(int32_t x, int32_t y, uint32_t s) const {
        const int64_t unit = (int64_t{1} << rules_.subPixelBits) / 16;
        return {(int64_t{x} << rules_.subPixelBits) + positions_[s].x * unit,
                (int64_t{y} << rules_.subPixelBits) + positions_[s].y * unit};
    }

    // The two pixel rows of quads that begin at `row`.
    Status shadeRow(const PreparedTriangle& t, uint32_t row, const FragmentShader* shader, const OutputState& output,
                    ShaderResources& resources) {
        const int32_t y0 = std::max<int32_t>(t.bounds.y0, static_cast<int32_t>(row));
        const int32_t y1 = std::min<int32_t>(t.bounds.y1, static_cast<int32_t>(row) + 2);
        if (y0 >= y1) return {};
        std::vector<SampleVerdict> verdicts(4 * samples_);
        for (int32_t qx = t.bounds.x0 & ~1; qx < t.bounds.x1; qx += 2) {
            std::array<bool, 4> covered{};
            for (int32_t lane = 0; lane < 4; ++lane) {
                const int32_t x = qx + lane % 2, y = static_cast<int32_t>(row) + lane / 2;
                if (x < t.bounds.x0 || x >= t.bounds.x1 || y < y0 || y >= y1) continue;
                for (uint32_t s = 0; s < samples_; ++s) {
                    SampleVerdict& verdict = verdicts[static_cast<size_t>(lane) * samples_ + s];
                    verdict = SampleVerdict{};
                    if (!(output.pipeline->sampleMask & (1u << s))) continue;
                    verdict = t.triangle.classify(samplePoint(x, y, s));
                    if (t.culled) verdict.nominalAsWhole = false;
                    covered[static_cast<size_t>(lane)] = covered[static_cast<size_t>(lane)] || verdict.possible;
                }
            }
            if (std::ranges::none_of(covered, [](bool c) { return c; })) continue;
            std::array<FragmentResult, 4> fragments{};
            if (shader) {
                auto shaded = shader->evaluate(t.source, static_cast<uint32_t>(qx), row, covered, output, resources);
                if (!shaded) return shaded.error();
                fragments = std::move(*shaded);
            } else {
                for (FragmentResult& fragment : fragments) fragment.colorFlags.fill(kOracleUnknown);
            }
            for (size_t lane = 0; lane < 4; ++lane) {
                if (!covered[lane]) continue;
                const int32_t x = qx + static_cast<int32_t>(lane % 2), y = static_cast<int32_t>(row + lane / 2);
                for (uint32_t s = 0; s < samples_; ++s) {
                    applySample(t, x, y, s, verdicts[lane * samples_ + s], fragments[lane], output);
                }
            }
        }
        return {};
    }

    void applySample(const PreparedTriangle& t, int32_t x, int32_t y, uint32_t s, const SampleVerdict& verdict,
                     const FragmentResult& fragment, const OutputState& output) {
        if (!verdict.possible) return;
        SampleInput input;
        input.verdict = verdict;
        input.fragment = &fragment;
        if (output.pipeline->alphaToCoverage && samples_ > 1) {
            const Interval& alpha = fragment.colors[0][3];
            if (alpha.high <= 0) return;
            input.coverageOpen = alpha.low < 1 - kCodeTolerance;
        }
        input.depth = t.triangle.depth(samplePoint(x, y, s)) + t.bias;
        // Without depth clamping fragments beyond the viewport's range have been clipped; rounding leaves no
        // more than a trace.
        const auto [low, high] = std::minmax(output.viewport.minDepth, output.viewport.maxDepth);
        if (!output.pipeline->depthClamp && !output.pipeline->depthBias) input.depth = input.depth.clamped(low, high);
        input.depthOrigin = t.depthOrigin;
        input.frontFacing = t.source.frontFacing;
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
            const ImageLevel& source = images_[a.image].level(a.mipLevel, a.layer);
            ImageLevel& target = images_[a.resolveImage].level(0, 0);
            for (uint32_t y = 0; y < height_; ++y) {
                for (uint32_t x = 0; x < width_; ++x) {
                    target.at(x, y) = resolveSamples(images_[a.image].format(), source, x, y);
                }
            }
        }
    }

    const Scene& scene_;
    const ScenePass& pass_;
    const OracleRules& rules_;
    std::vector<ImageStore>& images_;
    uint32_t width_ = 0, height_ = 0, samples_ = 1;
    OutputState output_;  // attachments only
    std::vector<GridPoint> positions_;
    std::vector<Sample> state_;
};

}  // namespace

Status renderPass(const Scene& scene, const ScenePass& pass, const OracleRules& rules,
                  std::vector<ImageStore>& images) {
    return PassRenderer(scene, pass, rules, images).run();
}

}  // namespace vernier::conformance::exact
