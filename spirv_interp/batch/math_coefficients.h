// Made by math_coefficients.py; see there for the functions and the method. Coefficients, constant first.
#pragma once

namespace vernier::batch::coefficients {

struct Fast {
    static constexpr float exp2[] = {0x1.62eee80000000p-1f, 0x1.efa13c0000000p-3f, 0x1.c3494c0000000p-5f};
    static constexpr float exp[] = {0x1.0007bc0000000p+0f, 0x1.01e5aa0000000p-1f, 0x1.52c74a0000000p-3f};
    static constexpr float sine[] = {-0x1.541d220000000p-3f, 0x1.f381300000000p-8f};
    static constexpr float tangent[] = {0x1.5755b60000000p-2f, 0x1.daeedc0000000p-4f, 0x1.8561fe0000000p-4f};
    static constexpr float log2[] = {0x1.7151440000000p+0f, -0x1.70eca00000000p-1f, 0x1.f0f4420000000p-2f,
                                     -0x1.9044ea0000000p-2f, 0x1.04dbc40000000p-2f};
    static constexpr float log[] = {-0x1.ffb8b40000000p-2f, 0x1.56aa6a0000000p-2f, -0x1.12e4c60000000p-2f,
                                    0x1.7d73c00000000p-3f};
    static constexpr float arctangent[] = {-0x1.53d0420000000p-2f, 0x1.5d14c40000000p-3f};
    static constexpr float arcsine[] = {0x1.5201420000000p-3f, 0x1.82915c0000000p-4f};
    static constexpr float hyperbolicSine[] = {0x1.5527860000000p-3f, 0x1.1a44080000000p-7f};
};

struct Standard {
    static constexpr float exp2[] = {0x1.62e4300000000p-1f, 0x1.ebfbde0000000p-3f,  0x1.c6af740000000p-5f,
                                     0x1.3b2d580000000p-7f, 0x1.5f05360000000p-10f, 0x1.41a7080000000p-13f};
    static constexpr float exp[] = {0x1.0000000000000p+0f, 0x1.fffffc0000000p-2f, 0x1.5554820000000p-3f,
                                    0x1.55582e0000000p-5f, 0x1.123ae20000000p-7f, 0x1.6a87b80000000p-10f};
    static constexpr float sine[] = {-0x1.55554a0000000p-3f, 0x1.110e740000000p-7f, -0x1.9f5dd80000000p-13f,
                                     0x1.5cb5220000000p-19f};
    static constexpr float tangent[] = {0x1.5554ac0000000p-2f, 0x1.1138080000000p-3f, 0x1.b4379c0000000p-5f,
                                        0x1.99affe0000000p-6f, 0x1.20d3e40000000p-9f, 0x1.452d440000000p-7f};
    static constexpr float log2[] = {0x1.7154760000000p+0f,  -0x1.7154700000000p-1f, 0x1.ec73d60000000p-2f,
                                     -0x1.715c4e0000000p-2f, 0x1.26d3880000000p-2f,  -0x1.e95bf80000000p-3f,
                                     0x1.b9c8e60000000p-3f,  -0x1.a87c440000000p-3f, 0x1.01b6480000000p-3f};
    static constexpr float log[] = {-0x1.fffffc0000000p-2f, 0x1.5556240000000p-2f,  -0x1.0005640000000p-2f,
                                    0x1.9913b80000000p-3f,  -0x1.5331060000000p-3f, 0x1.2e97bc0000000p-3f,
                                    -0x1.25ecf20000000p-3f, 0x1.79e5920000000p-4f};
    static constexpr float arctangent[] = {-0x1.5554580000000p-2f, 0x1.9925e20000000p-3f, -0x1.1c428c0000000p-3f,
                                           0x1.4a27620000000p-4f};
    static constexpr float arcsine[] = {0x1.5555ca0000000p-3f, 0x1.3301520000000p-4f, 0x1.748c120000000p-5f,
                                        0x1.8ba55e0000000p-6f, 0x1.59d8480000000p-5f};
    static constexpr float hyperbolicSine[] = {0x1.5555560000000p-3f, 0x1.1111360000000p-7f, 0x1.9ffe120000000p-13f,
                                               0x1.7a267a0000000p-19f};
};

struct Fine {
    static constexpr double exp2[] = {0x1.62e42ff00e698p-1, 0x1.ebfbe04309a8ap-3,  0x1.c6b08ba1a3200p-5,
                                      0x1.3b2a1e6032931p-7, 0x1.5d8a2b5c86a94p-10, 0x1.443da53572470p-13,
                                      0x1.fde1b5093986bp-17};
    static constexpr double exp[] = {0x1.000000004d08ap+0, 0x1.00000026f4857p-1, 0x1.555553fa05ce6p-3,
                                     0x1.5554b00e57c7ap-5, 0x1.1112c421377cap-7, 0x1.6d728ac2f9b16p-10,
                                     0x1.9e8b6649db40fp-13};
    static constexpr double sine[] = {-0x1.5555554350576p-3, 0x1.11110b33879fdp-7, -0x1.a0177e646d4b9p-13,
                                      0x1.7164cd3b77ff5p-19, -0x1.99616330e3a26p-26};
    static constexpr double tangent[] = {0x1.555553bba8fe5p-2,   0x1.1111af1490bd4p-3, 0x1.b9f24149ef188p-5,
                                         0x1.68e7dec7ce47ap-6,   0x1.0babf4c4673b0p-7, 0x1.5d18fdc6b48f4p-8,
                                         -0x1.f1c457a94798fp-11, 0x1.1f4fe0c87b41cp-9};
    static constexpr double logarithm[] = {0x1.555554fd9e59cp-2, 0x1.999a7a89714b1p-3, 0x1.2438d7bb98707p-3,
                                           0x1.e2f662530da8dp-4};
    static constexpr double arctangent[] = {-0x1.555554c8c5a2ep-2, 0x1.99991a64d524ap-3,  -0x1.247f0992f9d2cp-3,
                                            0x1.c4684cea820e5p-4,  -0x1.5b4709224ef92p-4, 0x1.84fc73856c09bp-5};
    static constexpr double arcsine[] = {0x1.555555479ef24p-3,  0x1.333340b9a7100p-4, 0x1.6db24f66149d2p-5,
                                         0x1.f28356d76659bp-6,  0x1.6634deee61afbp-6, 0x1.5276819ddb420p-6,
                                         0x1.ff60e2c3ece04p-10, 0x1.0dd6e4c299e6ep-5};
    static constexpr double hyperbolicSine[] = {0x1.5555555578bc9p-3, 0x1.111110f1bb9b0p-7, 0x1.a01a25a442fe1p-13,
                                                0x1.71cc2bbcf2b5fp-19, 0x1.b6995b0c4047bp-26};
};

struct Reference {
    static constexpr double exp2[] = {0x1.62e42fefa39efp-1,  0x1.ebfbdff82c58fp-3,  0x1.c6b08d704a0c6p-5,
                                      0x1.3b2ab6fba4e44p-7,  0x1.5d87fe78a40a8p-10, 0x1.430912f87e0d1p-13,
                                      0x1.ffcbfc6d48f9fp-17, 0x1.62c021eda8e09p-20, 0x1.b524eca86d43fp-24,
                                      0x1.e4d065d0c3373p-28, 0x1.e9eac6c3bd29dp-32, 0x1.c2b1d0c65facdp-36};
    static constexpr double exp[] = {0x1.0000000000000p+0,  0x1.0000000000005p-1,  0x1.5555555555503p-3,
                                     0x1.5555555552241p-5,  0x1.1111111125e90p-7,  0x1.6c16c17ee5670p-10,
                                     0x1.a01a012c0dad3p-13, 0x1.a019a770752a0p-16, 0x1.71df3322a8783p-19,
                                     0x1.28a1cddd74831p-22, 0x1.ad511d372436ep-26};
    static constexpr double sine[] = {-0x1.5555555555555p-3,  0x1.1111111111111p-7,   -0x1.a01a01a019fc0p-13,
                                      0x1.71de3a5568e06p-19,  -0x1.ae64567cbf09bp-26, 0x1.61246018faaf2p-33,
                                      -0x1.ae7ea1d37fb5fp-41, 0x1.94f946a45eef0p-49,  -0x1.2601d6f0d9779p-57};
    static constexpr double tangent[] = {0x1.5555555555472p-2,   0x1.1111111120815p-3,   0x1.ba1ba1ae5ecd8p-5,
                                         0x1.664f4ac2a7505p-6,   0x1.226df41ddb839p-7,   0x1.d6dd5a461346cp-9,
                                         0x1.7d2a3c3cc1e79p-10,  0x1.398d7889f00ddp-11,  0x1.c05547ed201b4p-13,
                                         0x1.4292df10cac15p-13,  -0x1.a50835b3c4662p-15, 0x1.d0dc9194f26e7p-14,
                                         -0x1.d717d65ec9755p-15, 0x1.8a89f05aef949p-16};
    static constexpr double logarithm[] = {0x1.5555555555555p-2, 0x1.9999999999dfep-3, 0x1.249249242b530p-3,
                                           0x1.c71c7258e95eep-4, 0x1.745cde3be4400p-4, 0x1.3b20aa7e76ae1p-4,
                                           0x1.0f5ce11442b63p-4, 0x1.0f62368a7da1ep-4};
    static constexpr double arctangent[] = {-0x1.555555555553dp-2, 0x1.99999999958ffp-3,  -0x1.24924922b18d6p-3,
                                            0x1.c71c70e7cb153p-4,  -0x1.745cf90fac1f4p-4, 0x1.3b111cb702364p-4,
                                            -0x1.10ebe15cef0e6p-4, 0x1.df119f5b5d311p-5,  -0x1.9cdd28f287d5dp-5,
                                            0x1.37efe02ade3acp-5,  -0x1.25a32b9ba5a22p-6};
    static constexpr double arcsine[] = {
        0x1.5555555555553p-3,  0x1.3333333333a5cp-4, 0x1.6db6db6d46f58p-5,  0x1.f1c71ca8f9300p-6, 0x1.6e8b9ad9d1f75p-6,
        0x1.1c4f87670e5afp-6,  0x1.c980aae60ddb2p-7, 0x1.7ba64239c59f5p-7,  0x1.36b4e2191df3ep-7, 0x1.484d6b61f7978p-7,
        0x1.55a4cf44f3fa1p-11, 0x1.97d706b27b4bdp-6, -0x1.add1a33588c3dp-6, 0x1.1401685494d19p-5};
    static constexpr double hyperbolicSine[] = {0x1.5555555555555p-3,  0x1.1111111111111p-7,  0x1.a01a01a01a01ap-13,
                                                0x1.71de3a556c706p-19, 0x1.ae64567f59b4cp-26, 0x1.6124613448828p-33,
                                                0x1.ae7f475722e54p-41, 0x1.9524d7535d8bep-49, 0x1.32e580b24758ep-57};
};

}  // namespace vernier::batch::coefficients
