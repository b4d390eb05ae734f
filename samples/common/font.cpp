#include "samples/common/font.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace samples {
namespace {

/// For each character from space on: lines through points, parted by blanks. A point is x 0..4 and y 0..8, y down;
/// capitals stand from 0 to 6, small letters from 2 to 6 and reach down to 8. A point alone is a dot.
constexpr const char* kStrokes[] = {"",
                                    "2024 26",
                                    "1012 3032",
                                    "1016 3036 0242 0444",
                                    "413010010213334445361605 2026",
                                    "0640 01 45",
                                    "4612112031320405162644",
                                    "2022",
                                    "30121436",
                                    "10323416",
                                    "2125 0244 0442",
                                    "2125 0343",
                                    "2618",
                                    "0343",
                                    "26",
                                    "0640",
                                    "103041453616050110 0541",
                                    "112026 1636",
                                    "0110304142330646",
                                    "01103041423313 334445361605",
                                    "36300444",
                                    "400003334445361605",
                                    "4130100105163645443303",
                                    "00402326",
                                    "103041423313020110 3344453616050413",
                                    "0516364541301001021343",
                                    "22 25",
                                    "22 2618",
                                    "410345",
                                    "0242 0444",
                                    "014305",
                                    "01103041422324 26",
                                    "4536160501103041443432222434",
                                    "0602204246 0444",
                                    "00063645443303 0030414233",
                                    "4130100105163645",
                                    "00062644422000",
                                    "40000646 0333",
                                    "400006 0333",
                                    "41301001051636454323",
                                    "0006 4046 0343",
                                    "1030 2026 1636",
                                    "2040 3035261605",
                                    "0006 400346",
                                    "000646",
                                    "0600234046",
                                    "06004640",
                                    "103041453616050110",
                                    "06003041423303",
                                    "103041453616050110 2446",
                                    "06003041423303 2346",
                                    "413010010213334445361605",
                                    "0040 2026",
                                    "000516364540",
                                    "002640",
                                    "0016233640",
                                    "0046 4006",
                                    "002340 2326",
                                    "00400646",
                                    "30101636",
                                    "0046",
                                    "10303616",
                                    "022042",
                                    "0747",
                                    "1021",
                                    "4332120305163645 4246",
                                    "0006 0312324345361605",
                                    "4332120305163645",
                                    "4046 4332120305163645",
                                    "04444332120305163645",
                                    "40302126 1232",
                                    "4332120305163645 4247381807",
                                    "0006 0312324346",
                                    "2226 20",
                                    "3237281807 30",
                                    "0006 420446",
                                    "102026 1636",
                                    "0602 03122326 23324346",
                                    "0602 0312324346",
                                    "123243453616050312",
                                    "0208 0312324345361605",
                                    "4248 4332120305163645",
                                    "0602 04123243",
                                    "4212031434453606",
                                    "20253646 1232",
                                    "0205163645 4246",
                                    "022642",
                                    "0216233642",
                                    "0246 4206",
                                    "0226 421808",
                                    "02420646",
                                    "30212213242536",
                                    "2026",
                                    "10212233242516",
                                    "03123443"};
static_assert(std::size(kStrokes) == '~' - ' ' + 1);

/// Distance of (x, y) from the line between two points.
double distanceTo(double x0, double y0, double x1, double y1, double x, double y) {
    const double dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? std::clamp(((x - x0) * dx + (y - y0) * dy) / length2, 0.0, 1.0) : 0;
    const double ex = x - x0 - t * dx, ey = y - y0 - t * dy;
    return std::sqrt(ex * ex + ey * ey);
}

/// Distance of (x, y) from the nearest line of the character.
double distanceTo(const char* strokes, double x, double y) {
    double nearest = 100;
    bool started = false;
    double lastX = 0, lastY = 0;
    for (const char* at = strokes; *at;) {
        if (*at == ' ') {
            started = false;
            ++at;
            continue;
        }
        const double nextX = at[0] - '0', nextY = at[1] - '0';
        if (!started) lastX = nextX, lastY = nextY;
        nearest = std::min(nearest, distanceTo(lastX, lastY, nextX, nextY, x, y));
        started = true;
        lastX = nextX;
        lastY = nextY;
        at += 2;
    }
    return nearest;
}

/// Of the block for unknown characters: 0 inside.
double blockDistance(double x, double y) {
    return std::max({0.0, -x, x - 4, -y, y - 6});
}

}  // namespace

std::vector<uint8_t> fontTexels(uint32_t unit) {
    const uint32_t cellWidth = 6 * unit, cellHeight = 10 * unit, width = kFontColumns * cellWidth;
    std::vector<uint8_t> texels(size_t{width} * kFontRows * cellHeight);
    for (uint32_t character = 0; character < kFontColumns * kFontRows; ++character)
        for (uint32_t y = 0; y < cellHeight; ++y)
            for (uint32_t x = 0; x < cellWidth; ++x) {
                // Texel centres; one unit is left free to the left and above.
                const double across = (x + 0.5) / unit - 1, down = (y + 0.5) / unit - 1;
                const double distance = character < std::size(kStrokes) ? distanceTo(kStrokes[character], across, down)
                                                                        : blockDistance(across, down);
                const double coverage = std::clamp((0.5 - distance) * unit + 0.5, 0.0, 1.0);
                const size_t row = size_t{character} / kFontColumns * cellHeight + y;
                texels[row * width + character % kFontColumns * cellWidth + x] =
                    static_cast<uint8_t>(coverage * 255 + 0.5);
            }
    return texels;
}

}  // namespace samples
