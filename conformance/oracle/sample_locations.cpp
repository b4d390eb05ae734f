#include "conformance/oracle/sample_locations.h"

namespace vernier::conformance::exact {

std::vector<GridPoint> standardSampleLocations(uint32_t samples) {
    switch (samples) {
        case 1:
            return {{8, 8}};
        case 2:
            return {{12, 12}, {4, 4}};
        case 4:
            return {{6, 2}, {14, 6}, {2, 10}, {10, 14}};
        case 8:
            return {{9, 5}, {7, 11}, {13, 9}, {5, 3}, {3, 13}, {1, 7}, {11, 15}, {15, 1}};
        case 16:
            return {{9, 9},  {7, 5}, {5, 10}, {12, 7}, {3, 6}, {10, 13}, {13, 11}, {11, 3},
                    {6, 14}, {8, 1}, {4, 2},  {2, 12}, {0, 8}, {15, 4},  {14, 15}, {1, 0}};
        default:
            return {};
    }
}

}  // namespace vernier::conformance::exact
