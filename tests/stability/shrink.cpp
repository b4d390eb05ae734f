#include "tests/stability/shrink.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vernier::stability {
namespace {

class Shrinker {
  public:
    Shrinker(Soup soup, const Fails& fails, size_t budget) : soup_(std::move(soup)), fails_(fails), budget_(budget) {}

    Soup run() {
        bool changed = true;
        while (changed && budget_ != 0) {
            changed = removeTriangles();
            changed = simplifyCoordinates() || changed;
        }
        return std::move(soup_);
    }

  private:
    /// Takes the candidate if it fails too.
    bool take(Soup candidate) {
        if (budget_ == 0) return false;
        --budget_;
        if (!fails_(candidate)) return false;
        soup_ = std::move(candidate);
        return true;
    }

    bool removeTriangles() {
        bool any = false;
        for (size_t part = std::max<size_t>(1, soup_.size() / 2);; part = std::max<size_t>(1, part / 2)) {
            bool removed = false;
            for (size_t at = 0; at < soup_.size() && soup_.size() > 1;) {
                Soup rest(soup_.begin(), soup_.begin() + static_cast<ptrdiff_t>(at));
                rest.insert(rest.end(), soup_.begin() + static_cast<ptrdiff_t>(std::min(soup_.size(), at + part)),
                            soup_.end());
                if (!rest.empty() && take(std::move(rest))) {
                    removed = any = true;
                } else {
                    at += part;
                }
            }
            if (part == 1 && !removed) return any;
        }
    }

    /// Simpler numbers for a coordinate, the simplest first.
    static std::vector<float> simplerThan(float value) {
        std::vector<float> result;
        const auto add = [&](float candidate) {
            if (candidate != value && std::ranges::count(result, candidate) == 0) result.push_back(candidate);
        };
        if (value == 0) return result;
        add(0);
        add(value < 0 ? -1.0f : 1.0f);
        if (!std::isfinite(value)) return result;
        if (std::abs(value) < 0x1p24f) add(std::nearbyint(value));
        // The leading bits alone: 1, 2, 4, 8 and 16 of the 24.
        const int exponent = std::ilogb(value);
        for (const int bits : {0, 1, 3, 7, 15})
            add(std::ldexp(std::nearbyint(std::ldexp(value, bits - exponent)), exponent - bits));
        // Not back up: only numbers that are simpler than the one that is there.
        const auto simplicity = [](float v) {
            int bits = 0;
            float mantissa = std::frexp(v, &bits);
            for (bits = 0; mantissa != std::nearbyint(mantissa) && bits < 24; ++bits) mantissa *= 2;
            return v == 0 ? -2 : std::abs(v) == 1 ? -1 : bits;
        };
        std::erase_if(result, [&](float candidate) { return simplicity(candidate) >= simplicity(value); });
        return result;
    }

    bool simplifyCoordinates() {
        bool any = false;
        std::vector<Position> positions;
        for (const Triangle& triangle : soup_) {
            for (const Position& p : triangle) {
                if (std::ranges::none_of(positions, [&](const Position& q) { return sameBits(p, q); }))
                    positions.push_back(p);
            }
        }
        for (Position position : positions) {
            for (size_t c = 0; c < 4; ++c) {
                for (const float simpler : simplerThan(position[c])) {
                    Position replaced = position;
                    replaced[c] = simpler;
                    Soup candidate = soup_;
                    for (Triangle& triangle : candidate) {
                        for (Position& p : triangle) {
                            if (sameBits(p, position)) p = replaced;
                        }
                    }
                    if (!take(std::move(candidate))) continue;
                    position = replaced;
                    any = true;
                    break;
                }
            }
        }
        return any;
    }

    static bool sameBits(const Position& a, const Position& b) {
        return std::equal(a.begin(), a.end(), b.begin(),
                          [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
    }

    Soup soup_;
    const Fails& fails_;
    size_t budget_;
};

}  // namespace

Soup shrink(Soup failing, const Fails& fails, size_t budget) {
    return Shrinker(std::move(failing), fails, budget).run();
}

}  // namespace vernier::stability
