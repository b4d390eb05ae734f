// Made by math_coefficients.py; see there for the functions and the method. Coefficients, constant first.
#pragma once

namespace vernier::batch::coefficients {

struct Fast {
    static constexpr float exp2[] = {0x1.62e2d20000000p-1f, 0x1.ebfb3e0000000p-3f, 0x1.c96d5e0000000p-5f,
                                     0x1.3c6e5c0000000p-7f};
    static constexpr float exp[] = {0x1.0000000000000p-1f, 0x1.56dfc40000000p-3f, 0x1.565c260000000p-5f};
    static constexpr float sine[] = {-0x1.55506e0000000p-3f, 0x1.0d160a0000000p-7f};
    static constexpr float cosine[] = {0x1.5552e00000000p-5f, -0x1.681a320000000p-10f};
    static constexpr float logarithm[] = {0x1.5861380000000p-2f};
    static constexpr float arctangent[] = {-0x1.54dbea0000000p-2f, 0x1.6ca2e60000000p-3f};
    static constexpr float arcsine[] = {0x1.5479580000000p-3f, 0x1.69023a0000000p-4f};
    static constexpr float hyperbolicSine[] = {0x1.5548260000000p-3f, 0x1.17a5dc0000000p-7f};
};

struct Standard {
    static constexpr float exp2[] = {0x1.62e4300000000p-1f, 0x1.ebfbe00000000p-3f,  0x1.c6af6c0000000p-5f,
                                     0x1.3b2a540000000p-7f, 0x1.5f08900000000p-10f, 0x1.44138a0000000p-13f};
    static constexpr float exp[] = {0x1.0000000000000p-1f, 0x1.5554de0000000p-3f, 0x1.55551a0000000p-5f,
                                    0x1.120b620000000p-7f, 0x1.6d10fc0000000p-10f};
    static constexpr float sine[] = {-0x1.5555520000000p-3f, 0x1.110c280000000p-7f, -0x1.9ac9b00000000p-13f};
    static constexpr float cosine[] = {0x1.5555540000000p-5f, -0x1.6c12d20000000p-10f, 0x1.9bd89c0000000p-16f};
    static constexpr float logarithm[] = {0x1.55555c0000000p-2f, 0x1.997c300000000p-3f, 0x1.2ee6100000000p-3f};
    static constexpr float arctangent[] = {-0x1.5555360000000p-2f, 0x1.996baa0000000p-3f, -0x1.1f36e60000000p-3f,
                                           0x1.5cffd60000000p-4f};
    static constexpr float arcsine[] = {0x1.55555e0000000p-3f, 0x1.3327320000000p-4f, 0x1.70a6bc0000000p-5f,
                                        0x1.b311d20000000p-6f, 0x1.37fe160000000p-5f};
    static constexpr float hyperbolicSine[] = {0x1.5555560000000p-3f, 0x1.11111e0000000p-7f, 0x1.a009000000000p-13f,
                                               0x1.78a70e0000000p-19f};
};

struct Fine {
    static constexpr double exp2[] = {0x1.62e42fefa39efp-1,  0x1.ebfbdff82c598p-3,  0x1.c6b08d704a0c2p-5,
                                      0x1.3b2ab6fba1ddap-7,  0x1.5d87fe78a5276p-10, 0x1.430913096fd9fp-13,
                                      0x1.ffcbfc670dcd4p-17, 0x1.62bfd47773353p-20, 0x1.b524fae627834p-24,
                                      0x1.e6063f7217bc6p-28, 0x1.e9d3fe3952179p-32};
    static constexpr double exp[] = {0x1.0000000000001p-1,  0x1.5555555555556p-3,  0x1.5555555553d68p-5,
                                     0x1.11111111109b5p-7,  0x1.6c16c17889ef1p-10, 0x1.a01a01a7c2efep-13,
                                     0x1.a019b9149a41cp-16, 0x1.71de0db2f6b19p-19, 0x1.28917c89a43a7p-22,
                                     0x1.af389ecfc4b9cp-26};
    static constexpr double sine[] = {-0x1.5555555555555p-3, 0x1.1111111111110p-7,   -0x1.a01a01a019938p-13,
                                      0x1.71de3a546095bp-19, -0x1.ae645412c560cp-26, 0x1.61217f0b800d5p-33,
                                      -0x1.ab17d404de5b3p-41};
    static constexpr double cosine[] = {0x1.5555555555555p-5,   -0x1.6c16c16c16c16p-10, 0x1.a01a01a019d0ap-16,
                                        -0x1.27e4fb7712d65p-22, 0x1.1eed8deb97a97p-29,  -0x1.9394ba0cd6ed5p-37,
                                        0x1.ab785b00b4646p-45};
    static constexpr double logarithm[] = {0x1.5555555555558p-2, 0x1.99999999952e2p-3, 0x1.2492492df148dp-3,
                                           0x1.c71c62e5800a1p-4, 0x1.7462b4ab2ef6bp-4, 0x1.39fe606542ddep-4,
                                           0x1.2b584aae78a57p-4};
    static constexpr double arctangent[] = {-0x1.5555555555546p-2, 0x1.9999999990a9fp-3,  -0x1.2492491dd4b29p-3,
                                            0x1.c71c6dd1ca28cp-4,  -0x1.745c7f8421f5cp-4, 0x1.3b068efc532d3p-4,
                                            -0x1.105e40d85ead1p-4, 0x1.d5eb9ad0804cfp-5,  -0x1.6f4657797fec3p-5,
                                            0x1.74bea059cee80p-6};
    static constexpr double arcsine[] = {
        0x1.5555555555556p-3, 0x1.3333333332ecap-4,  0x1.6db6db6e31f13p-5, 0x1.f1c71c1db0623p-6, 0x1.6e8bb1c8209a2p-6,
        0x1.1c4d35cf95421p-6, 0x1.c9cf07674736ap-7,  0x1.782651caa6547p-7, 0x1.52420b04b37bep-7, 0x1.65a9c4dfcf8b2p-8,
        0x1.1d189408314eep-6, -0x1.e6aaa8a0a04ccp-7, 0x1.d72b2bc8155f8p-6};
    static constexpr double hyperbolicSine[] = {0x1.5555555555555p-3,  0x1.1111111111111p-7,  0x1.a01a01a01a001p-13,
                                                0x1.71de3a556f96cp-19, 0x1.ae6456792a77fp-26, 0x1.612467ccb2260p-33,
                                                0x1.ae777c36fd5b6p-41, 0x1.99f0806c2628dp-49};
};

}  // namespace vernier::batch::coefficients
