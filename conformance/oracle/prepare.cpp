#include "conformance/oracle/prepare.h"

#include "conformance/oracle/depth_exact.h"

#include <algorithm>
#include <cmath>

namespace vernier::conformance::exact {
namespace {

Interval biasOf(const Triangle& triangle, const ScenePipeline& pipeline, VkFormat depthFormat) {
    std::array<Rational, 3> depths;
    const std::array<double, 3> z = triangle.vertexDepths();
    for (size_t i = 0; i < 3; ++i) depths[i] = rational(std::isfinite(z[i]) ? z[i] : 1.0);
    const BiasRange range =
        depthBias(depthFormat, depths, rational(triangle.depthSlopeX()), rational(triangle.depthSlopeY()),
                  pipeline.depthBiasConstant, pipeline.depthBiasClamp, pipeline.depthBiasSlope);
    return {(range.low + range.high) / 2, range.low, range.high};
}

/// Prepares one draw: remembers what goes from one primitive to the next.
class Preparer {
  public:
    Preparer(const PrepareContext& context, const DrawGeometry& geometry) : context_(context), geometry_(geometry) {}

    Result<std::vector<PreparedPrimitive>> run() {
        for (const AssembledPrimitive& primitive : geometry_.primitives) {
            const ShadedVertex& provoking = geometry_.vertices[primitive.provoking];
            if (context_.layer && provoking.layer != *context_.layer) continue;
            if (Status s = enterView(provoking.viewport); !s) return s.error();
            FragmentSource source;
            source.provoking = &provoking;
            source.primitiveId = primitive.id;
            source.frontFacing = true;  // of lines and points (Vulkan, FrontFacing)
            const auto vertex = [&](size_t i) { return &geometry_.vertices[primitive.vertices[i]]; };
            Status status;
            if (primitive.count == 1) {
                status = addPoint(*vertex(0), source, vertex(0)->pointSize);
            } else if (primitive.count == 2) {
                status = addLine(*vertex(0), *vertex(1), source, primitive.startsStrip);
            } else {
                status = addTriangle({vertex(0), vertex(1), vertex(2)}, source);
            }
            if (!status) return status.error();
        }
        for (PreparedPrimitive& p : result_) {
            p.source.triangle = &p.carrier;
            if (p.point) p.source.point = &*p.point;
        }
        return std::move(result_);
    }

  private:
    /// Takes the viewport and the scissor that a primitive chose.
    Status enterView(uint32_t index) {
        const SceneDraw& draw = context_.draw;
        if (index > draw.moreViews.size()) return unsupported("oracle: a viewport index beyond the viewports");
        viewport_ = index == 0 ? draw.viewport : draw.moreViews[index - 1].viewport;
        const VkRect2D& scissor = index == 0 ? draw.scissor : draw.moreViews[index - 1].scissor;
        limits_ = {std::max(0, scissor.offset.x), std::max(0, scissor.offset.y),
                   static_cast<int32_t>(
                       std::min<int64_t>(context_.extent.width, int64_t{scissor.offset.x} + scissor.extent.width)),
                   static_cast<int32_t>(
                       std::min<int64_t>(context_.extent.height, int64_t{scissor.offset.y} + scissor.extent.height))};
        const double numbers[] = {static_cast<double>(context_.pipeline.vertexShader),
                                  viewport_.x,
                                  viewport_.y,
                                  viewport_.width,
                                  viewport_.height,
                                  viewport_.minDepth,
                                  viewport_.maxDepth};
        viewHash_ = hashNumbers(0, numbers, std::size(numbers));
        return {};
    }

    Triangle::Setup setupOf(const std::array<const ShadedVertex*, 3>& vertices) const {
        Triangle::Setup setup{{},
                              viewport_,
                              context_.pipeline.depthClip.value_or(!context_.pipeline.depthClamp),
                              {},
                              viewHash_,
                              context_.rules.subPixelBits,
                              context_.rules.vertexFreedom,
                              context_.rules.planesBehindEye,
                              context_.rules.ties};
        size_t distances = ~size_t{0};
        for (size_t k = 0; k < 3; ++k) {
            setup.position[k] = vertices[k]->position;
            distances = std::min(distances, vertices[k]->clipDistances.size());
        }
        for (size_t d = 0; d < distances; ++d) {
            std::array<double, 3> cut;
            for (size_t k = 0; k < 3; ++k) cut[k] = vertices[k]->clipDistances[d];
            setup.clipDistances.push_back(cut);
        }
        return setup;
    }

    Status addTriangle(const std::array<const ShadedVertex*, 3>& vertices, FragmentSource source) {
        const ScenePipeline& pipeline = context_.pipeline;
        source.vertices = vertices;
        if (pipeline.polygonMode == VK_POLYGON_MODE_FILL) source.number(3, pipeline.provokingVertexLast);
        auto triangle = Triangle::create(setupOf(vertices));
        if (!triangle) return {};
        source.frontFacing = isFrontFacing(triangle->orientation(), pipeline.frontFace);
        const bool culled = (source.frontFacing && (pipeline.cullMode & VK_CULL_MODE_FRONT_BIT)) ||
                            (!source.frontFacing && (pipeline.cullMode & VK_CULL_MODE_BACK_BIT));
        if (pipeline.polygonMode != VK_POLYGON_MODE_FILL) {
            if (pipeline.depthBias) return unsupported("oracle: depth bias of polygons drawn as lines or points");
            return culled ? Status{} : addOutline(vertices, source);
        }
        if (culled && (!triangle->orientationOpen() || pipeline.cullMode == VK_CULL_MODE_FRONT_AND_BACK)) return {};
        const PixelBounds bounds = triangle->bounds(limits_);
        if (bounds.empty()) return {};
        PreparedPrimitive prepared{std::move(*triangle), source, bounds, viewport_, 0.0, 0, 0, culled, {}, {}};
        prepared.depthOrigin = prepared.carrier.identity();
        if (pipeline.depthBias && context_.depthFormat) {
            prepared.bias = biasOf(prepared.carrier, pipeline, context_.depthFormat->format);
            const double bias[] = {pipeline.depthBiasConstant, pipeline.depthBiasClamp, pipeline.depthBiasSlope};
            prepared.depthOrigin = hashNumbers(prepared.depthOrigin, bias, 3);
        }
        result_.push_back(std::move(prepared));
        return {};
    }

    /// A triangle's edges or corners. Those that a cut makes are left to the implementation: such triangles are
    /// refused.
    Status addOutline(const std::array<const ShadedVertex*, 3>& vertices, const FragmentSource& source) {
        for (const ShadedVertex* vertex : vertices) {
            const Clip<double>& p = vertex->position;
            const bool inside = std::abs(p[0]) <= p[3] && std::abs(p[1]) <= p[3] && p[2] >= 0 && p[2] <= p[3];
            if (!inside) return unsupported("oracle: outlines of clipped polygons");
        }
        const size_t first = result_.size();
        for (size_t i = 0; i < 3; ++i) {
            const Status status = context_.pipeline.polygonMode == VK_POLYGON_MODE_POINT
                                      ? addPoint(*vertices[i], source, vertices[i]->pointSize)
                                      : addLine(*vertices[i], *vertices[(i + 1) % 3], source, true);
            if (!status) return status;
        }
        ++outlines_;
        for (size_t i = first; i < result_.size(); ++i) result_[i].outline = outlines_;
        return {};
    }

    std::array<double, 2> windowOf(const ShadedVertex& vertex) const {
        const WindowVertex<double> v = toWindow(vertex.position, viewport_);
        return {v.x / v.w, v.y / v.w};
    }

    Status addLine(const ShadedVertex& a, const ShadedVertex& b, FragmentSource source, bool startsStrip) {
        const ScenePipeline& pipeline = context_.pipeline;
        const bool bresenham = pipeline.lineMode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
        if (!(a.position[3] > 0) || !(b.position[3] > 0)) return unsupported("oracle: lines behind the eye");
        if (bresenham && pipeline.lineWidth != 1) return unsupported("oracle: wide Bresenham lines");
        LineShape::Setup setup;
        setup.ends = {windowOf(a), windowOf(b)};
        setup.width = static_cast<double>(pipeline.lineWidth);
        setup.mode = pipeline.lineMode;
        setup.stippleFactor = pipeline.stippleFactor;
        setup.stipplePattern = pipeline.stipplePattern;
        setup.subPixelBits = context_.rules.subPixelBits;
        if (startsStrip) {
            stippleStart_ = 0;
            stippleFreedom_ = 0;
        }
        setup.stippleStart = stippleStart_;
        // Every segment may have one fragment more or less; a rectangle's pieces begin where it does, so that only
        // those before it matter.
        setup.stippleFreedom = bresenham ? ++stippleFreedom_ : stippleFreedom_++;
        LineShape line(setup);
        stippleStart_ += line.stippleCount();
        source.vertices = {&a, &b, &a};
        if (pipeline.polygonMode == VK_POLYGON_MODE_FILL) source.number(2, pipeline.provokingVertexLast);
        const PixelBounds bounds = line.bounds(limits_);
        return addShape(source, bounds, std::move(line), std::nullopt);
    }

    Status addPoint(const ShadedVertex& vertex, FragmentSource source, double size) {
        if (!(vertex.position[3] > 0)) return {};
        PointShape point({windowOf(vertex), size, context_.rules.subPixelBits});
        source.vertices = {&vertex, &vertex, &vertex};
        if (context_.pipeline.polygonMode == VK_POLYGON_MODE_FILL) source.number(1, false);
        const PixelBounds bounds = point.bounds(limits_);
        return addShape(source, bounds, std::nullopt, std::move(point));
    }

    Status addShape(const FragmentSource& source, const PixelBounds& bounds, std::optional<LineShape> line,
                    std::optional<PointShape> point) {
        const bool majorAxis = context_.rules.majorAxisLines && line &&
                               context_.pipeline.lineMode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
        auto carrier = Triangle::createCarrier(setupOf(source.vertices), majorAxis);
        if (!carrier || bounds.empty()) return {};
        const uint64_t origin = carrier->identity();
        result_.push_back(
            {std::move(*carrier), source, bounds, viewport_, 0.0, origin, 0, false, std::move(line), std::move(point)});
        return {};
    }

    const PrepareContext& context_;
    const DrawGeometry& geometry_;
    VkViewport viewport_{};
    PixelBounds limits_;
    uint64_t viewHash_ = 0;  // vertices with equal clip coordinates snap alike in one view
    double stippleStart_ = 0;
    int64_t stippleFreedom_ = 0;
    uint64_t outlines_ = 0;
    std::vector<PreparedPrimitive> result_;
};

}  // namespace

Result<std::vector<PreparedPrimitive>> preparePrimitives(const PrepareContext& context, const DrawGeometry& geometry) {
    return Preparer(context, geometry).run();
}

SampleVerdict PreparedPrimitive::classify(const GridPoint& sample) const {
    if (!line && !point) {
        SampleVerdict verdict = carrier.classify(sample);
        if (culled) verdict.nominalAsWhole = false;
        return verdict;
    }
    SampleVerdict verdict = line ? line->classify(sample) : point->classify(sample);
    if (!verdict.possible) return verdict;
    const SampleVerdict cuts = carrier.classifyCuts(sample);
    verdict.possible = cuts.possible;
    verdict.cutOpen = cuts.cutOpen;
    verdict.cutNominal = cuts.cutNominal;
    return verdict;
}

std::optional<double> PreparedPrimitive::smoothCoverage(const GridPoint& sample) const {
    return line ? line->smoothCoverage(sample) : std::nullopt;
}

std::vector<std::array<double, 2>> PreparedPrimitive::clippedPixel(int32_t x, int32_t y) const {
    if (line || point) return {};
    using Corner = std::array<double, 2>;
    std::vector<Corner> corners{{x + 0.0, y + 0.0}, {x + 1.0, y + 0.0}, {x + 1.0, y + 1.0}, {x + 0.0, y + 1.0}};
    const HomogeneousTriangle<double>& shape = carrier.homogeneous();
    const double side = shape.determinant < 0 ? -1 : 1;
    for (size_t i = 0; i < 3; ++i) {
        std::vector<Corner> kept;
        const auto inside = [&](const Corner& c) { return side * shape.weights(c[0], c[1])[i]; };
        for (size_t k = 0; k < corners.size(); ++k) {
            const Corner &a = corners[k], &b = corners[(k + 1) % corners.size()];
            const double da = inside(a), db = inside(b);
            if (da >= 0) kept.push_back(a);
            if ((da >= 0) == (db >= 0)) continue;
            const double t = da / (da - db);
            kept.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
        }
        corners = std::move(kept);
    }
    return corners;
}

}  // namespace vernier::conformance::exact
