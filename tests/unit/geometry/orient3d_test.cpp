// Proves that orient3d has the sign of the exact determinant, by comparison with rational arithmetic and integers of
// 128 bits.
#include "blum/geometry/orient3d.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "blum/core/random.hpp"

namespace blum::detail {
namespace {

struct Case {
  Vec3d a, b, c, d;
  int sign;
};

/// Points nearly in one plane, of magnitudes far apart, in the plane x = y except for an offset, or in a plane of far
/// grid points. Python's fractions.Fraction computed the signs.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {{0x1.f767c482c9b00p-3, 0x1.2e4738d8608fep-1, 0x1.5c8437bb9985ep-1},
       {0x1.3119920d46410p-2, -0x1.8c13bc5069136p-1, 0x1.7949c41f8fb2cp-1},
       {0x1.667d2c686bfa0p-4, -0x1.f29231a268928p-1, -0x1.78369970e7b00p-3},
       {0x1.96824fb86eb19p-2, 0x1.09f9c4b6e4858p-1, 0x1.50e2d673beddap+0},
       1},
      {{-0x1.71e6f430e7cb8p-1, -0x1.7e428e6f12bb6p-1, 0x1.e3ac62ef8a30cp-1},
       {-0x1.2984441cfae1cp-1, 0x1.d72b8efdbff98p-1, 0x1.7d5876154f5d0p-1},
       {-0x1.7da45a09dc944p-2, 0x1.4151938125520p-4, -0x1.45f8a6078e194p-1},
       {-0x1.766c65307cd19p-1, 0x1.e836c5b79d9f0p-2, 0x1.6500f0bce44cap+0},
       -1},
      {{-0x1.5c8ac7ab07cf0p-3, -0x1.e3b690ef53010p-2, -0x1.96d10a2ebeda8p-2},
       {0x1.8921395b1a328p-3, -0x1.bc649c58534c8p-1, 0x1.46299a272d1d0p-1},
       {0x1.92448c50d7d10p-2, -0x1.33b7cc383dd20p-5, -0x1.c5a18c5f356f2p-1},
       {0x1.1649ee68329b6p-1, -0x1.0e44147df954fp-1, 0x1.8f248f49c335ep-3},
       -1},
      {{0x1.91f2bf26a4de0p-4, -0x1.120ddf9fa6844p-2, -0x1.827ae7d026c50p-4},
       {0x1.faba83e90d568p-3, -0x1.861f799f44078p-1, 0x1.b7f79068e526ep-1},
       {-0x1.3eb4bf7ccd0fcp-2, 0x1.9222db43296dep-1, 0x1.1a37ad3b3ea92p-1},
       {-0x1.5b42a2c09dd20p-3, 0x1.9ace83c51d051p-2, 0x1.152062a76fb33p-1},
       -1},
      {{-0x1.12870a1bc0148p-3, -0x1.2a835454629d4p-1, 0x1.ac1f0c12f8130p-1},
       {-0x1.cb6a2f1367c90p-2, -0x1.801a0550648b4p-2, -0x1.8cf62ed290d14p-2},
       {0x1.03b2be261c374p-2, 0x1.fca5f43decf44p-1, 0x1.c2d2e60c6dea0p-2},
       {-0x1.9b4502ba90238p-1, -0x1.db553e34036aap+0, 0x1.ffa1515511ec0p-7},
       1},
      {{0x1.4e20692006d80p-1, 0x1.352de46bf8490p-2, -0x1.c6f4af02ae784p-1},
       {0x1.34e7853f2d1c8p-1, 0x1.5a8d349a80f04p-1, 0x1.ecda08dda72e0p-1},
       {0x1.0b0ec8e580c34p-2, -0x1.92cf6cea64140p-1, -0x1.0419d1d9cb0ecp-2},
       {0x1.ccaf457953359p-1, 0x1.5776df5b8b44cp+0, -0x1.14fd176039064p-4},
       1},
      {{0x1.e76e8742d743ap-1, 0x1.d72cabbe7bfe6p-1, -0x1.575e55cec6760p-5},
       {-0x1.ea321cc50a100p-5, -0x1.8cbcfacfbe70ap-1, 0x1.040635efe8b38p-2},
       {0x1.78a048ab5345ap-1, -0x1.a4b929410aaa6p-1, 0x1.f1619c8326500p-6},
       {0x1.c07e452405e0cp+0, 0x1.b935d3ec7de68p+0, -0x1.16d37f4ea9c2ep-2},
       -1},
      {{0x1.09debca72125cp-1, 0x1.e5e72ad160780p-4, 0x1.57472f3e2aeeep-1},
       {0x1.1438ae7d8ffc8p-1, 0x1.d3d9c5f907b3cp-1, 0x1.3291cc2dbbf74p-2},
       {-0x1.a5017b9fc33e0p-5, -0x1.648bf4540f35cp-2, -0x1.2f9a92d83ddd0p-4},
       {0x1.eef8816b28beep-3, -0x1.619c4bebfac96p-2, 0x1.b77e580aad5dap-2},
       -1},
      {{-0x1.331b8713e1f84p-2, 0x1.7aca03eef8ebcp-1, 0x1.e78c932ea08d8p-1},
       {0x1.29324922868e0p-5, -0x1.34944194e9a08p-1, 0x1.bfe0fc6d4b1d2p-1},
       {-0x1.bcb4d74efebbcp-2, 0x1.c1eafbabbd5e8p-2, -0x1.500ca5b10d56ap-1},
       {-0x1.f7a1ddaf6a11bp-2, 0x1.232114eb41f36p+0, 0x1.18477d35a04eep-2},
       1},
      {{-0x1.37b4eeeb845d4p-1, 0x1.fc32bb4cdc248p-3, -0x1.1fb4759ed92e8p-1},
       {0x1.0c0308b7ed25cp-2, 0x1.f224c53c5ce9ep-1, -0x1.5646d0f911d7ap-1},
       {-0x1.8e82e2d7610c4p-1, -0x1.1c116673ffa00p-5, -0x1.5a276511c03f0p-3},
       {-0x1.b2109495b7a6ap-1, 0x1.831646e29632cp-6, -0x1.dcba7b64eb586p-2},
       -1},
      {{0x1.be7ec4e736f4cp-2, -0x1.ff52d2d322260p-1, 0x1.cef508a3a6cecp-1},
       {0x1.7731e30ebac24p-1, 0x1.db83fc049daeep-1, -0x1.9ee711da3438cp-1},
       {0x1.cdedebca5acecp-1, 0x1.d54cba2d01d30p-1, -0x1.4b5bc72e77bb0p-3},
       {0x1.0328e42b37289p-1, -0x1.835d8d14436f4p-1, 0x1.9f5781671c105p-1},
       1},
      {{0x1.d42f89997dfd2p-1, 0x1.bcddba2e816d0p-3, 0x1.48f1a5725d206p-1},
       {-0x1.e3ed3fc8beed8p-3, 0x1.0d90e5d53c5b8p-3, -0x1.657fd15edbf40p-2},
       {-0x1.21fe3f22fa580p-3, -0x1.afde76ac13900p-7, 0x1.e3cb255aa986cp-1},
       {0x1.f564fcbc83b4bp-1, 0x1.8b280848a03c2p-3, 0x1.dc82e091e2090p-1},
       1},
      {{0x1.ed9f27fb218acp-24, -0x1.e43eafee7f500p-15, -0x1.ebdb485726028p+59},
       {0x1.efe62ea75bc7ep+1, 0x1.b7da8624a8b38p-43, -0x1.79e2afcf4f180p-50},
       {0x1.47ccee9f26da8p-6, -0x1.049b915a7b990p-56, 0x1.20779d9176df8p+44},
       {-0x1.b8c677f93d6b0p-2, 0x1.0ac5063dc3510p-29, -0x1.06af588849a02p-1},
       -1},
      {{0x1.20ac4a84b4a5ep-30, -0x1.43c96bb78c440p+42, -0x1.61851ca3a7522p-25},
       {-0x1.a78cea81fafd4p+15, 0x1.f84d8abcc0b8ep+5, 0x1.28b513dd0d214p+15},
       {0x1.85cbae5f2a218p+53, -0x1.86fc15fdee0d2p+36, -0x1.7ef1605982ff8p-25},
       {0x1.126a3ad5051b0p-21, 0x1.d1305e97f9130p+30, 0x1.e9596836825c0p-6},
       1},
      {{-0x1.33ae8aa392ec8p+25, 0x1.f5cb91d0090a8p+13, -0x1.785743fb564c2p-61},
       {-0x1.fb09ad725fa2cp-4, 0x1.7c6185eaa48acp-49, 0x1.8d404b57fd664p+8},
       {-0x1.3c3b7dfe22e1ap-7, 0x1.1d1058675d2d8p-7, 0x1.84ad8f26ba850p+25},
       {0x1.aa5ae9f4095c4p+18, 0x1.30dfd77b5c6d0p+47, 0x1.a598b2ebac746p-12},
       -1},
      {{-0x1.8dcedcdd75860p+22, 0x1.6858d65c1c298p-36, 0x1.98788025f2070p-2},
       {0x1.51f1b0e10c972p-53, -0x1.921fe129e9a4cp-62, 0x1.8e95b5c76c650p-7},
       {0x1.50554e929deb0p+19, 0x1.1f7776bc793b0p+55, -0x1.832c4cdb790ccp-41},
       {-0x1.61b0127029ce0p+5, 0x1.8e04c23fb40a8p-19, 0x1.36d7f09d36600p-10},
       -1},
      {{0x1.5fa6991533320p+40, -0x1.ce47d6f73e094p+32, -0x1.1475d4ddcc3b8p+43},
       {-0x1.a8c2541aa7eb6p-53, 0x1.4f0e40f131cd0p-59, -0x1.55e90b4703c78p-8},
       {0x1.ea2ca908cb500p-10, 0x1.9c27fd7c97c9cp-56, -0x1.81a9fa14374aap-46},
       {-0x1.1f819e31563eep+21, 0x1.4c224079e32a2p-47, 0x1.b31581e514a94p-45},
       -1},
      {{0x1.f9e90da570684p+29, 0x1.ac079f380f6a0p-42, -0x1.448524b1d777ep-38},
       {-0x1.6084626558fe8p-43, -0x1.bb2899b055082p-34, -0x1.d3644038e5038p-48},
       {0x1.481d126113304p+33, -0x1.b644995c2d34cp-54, 0x1.233d3f2687ea8p-48},
       {0x1.f04eb56606184p+50, 0x1.fac19a44c7470p-62, -0x1.17e0abd12f118p-23},
       -1},
      {{0x1.7bdb1299a7dccp+9, 0x1.7bdb1299a7dccp+9, -0x1.55734a5876380p-3},
       {0x1.a8bffa8722db2p-13, 0x1.a8bffa8722db2p-13, 0x1.9410124b730c4p-13},
       {0x1.192edb433fc60p+9, 0x1.192edb433fc60p+9, -0x1.ad987516ee8c8p+13},
       {0x1.98a5927bc7650p-10, 0x1.98a5927bc7650p-10, -0x1.e4dee6efd308cp+13},
       0},
      {{-0x1.0eb6685f76b1ap-3, -0x1.0eb6685f76b1ap-3, 0x1.167527cd02ca0p-17},
       {0x1.3b6be89e017c0p+2, 0x1.3b6be89e017c0p+2, -0x1.7e40d50d90a70p+0},
       {-0x1.48603c6f3566ep-20, -0x1.48603c6f3566ep-20, 0x1.3d77d85773604p-17},
       {0.0, 0x1.a95a5b7f87a0fp-117, -0x1.a2a229917c9aap-14},
       -1},
      {{-0x1.c32a6e3f03788p+6, -0x1.c32a6e3f03788p+6, -0x1.4003704b29160p-5},
       {-0x1.91d8291a0d7b4p+12, -0x1.91d8291a0d7b4p+12, -0x1.e1d4fb3a9c70ap+3},
       {-0x1.c90d90936cc44p-12, -0x1.c90d90936cc44p-12, 0x1.c74a55f9dc7eap+6},
       {0.0, 0x1.4c4e977ba1f5cp-110, 0x1.ff323d1db745cp-17},
       1},
      {{-0x1.70e162a635972p+18, -0x1.70e162a635972p+18, -0x1.fc706d4a996b8p-8},
       {-0x1.ae7c3aaaaf240p+17, -0x1.ae7c3aaaaf240p+17, 0x1.a4818159428d0p+2},
       {-0x1.f324a3ba26738p-1, -0x1.f324a3ba26738p-1, 0x1.2ee0cb4bc0edcp+18},
       {-0x1.10d0ee13d7640p+0, -0x1.10d0ee13d7640p+0, 0x1.1e93784a722c0p+12},
       0},
      {{0x1.f8e7a6c960886p-8, 0x1.f8e7a6c960886p-8, 0x1.ebd9052e37974p+3},
       {-0x1.bf332573958b8p-19, -0x1.bf332573958b8p-19, -0x1.de09d6e825f44p-9},
       {-0x1.37b50ffaf3336p+10, -0x1.37b50ffaf3336p+10, 0x1.8e998177f3794p+9},
       {0.0, 0x1.011c2eaabe7d8p-196, -0x1.ff8cc0c95877cp+9},
       1},
      {{0x1.afd5bdb6ddd58p-1, 0x1.afd5bdb6ddd58p-1, -0x1.1a059e2704380p-18},
       {-0x1.3bccb4ec33aacp-11, -0x1.3bccb4ec33aacp-11, -0x1.b719d9500bfd8p+3},
       {0x1.79c53df0af12ep+9, 0x1.79c53df0af12ep+9, -0x1.643c3fb955ff6p-5},
       {0.0, -0x1.dee7a4ad4b81fp-167, 0x1.00606fa4be26cp-6},
       1},
      {{-0x1.be351088e6000p+40, 4.0, -0x1.be351088e2000p+39},
       {0x1.0d79d2c140000p+39, -16.0, 0x1.0d79d2c120000p+38},
       {-0x1.d29fe3eadc000p+40, 10.0, -0x1.d29fe3ead2000p+39},
       {-0x1.8037e7ea30000p+39, -12.0, -0x1.8037e7ea48000p+38},
       0},
      {{0x1.52982575e0000p+38, 10.0, 0x1.5298257608000p+37},
       {-0x1.4a6ac783e0000p+36, -8.0, -0x1.4a6ac78460000p+35},
       {-0x1.97bb538120000p+38, -18.0, -0x1.97bb538168000p+37},
       {-0x1.36cdf25090000p+37, -14.0, -0x1.36cdf25100000p+36},
       0},
      {{0x1.353c33a44c000p+40, 4.0, 0x1.353c33a450000p+39},
       {0x1.fd71b70fc0000p+38, -8.0, 0x1.fd71b70fa0000p+37},
       {0x1.c9df451428000p+39, 0.0, 0x1.c9df451428000p+38},
       {-0x1.6220baa5c0000p+39, -4.0, -0x1.6220baa5c8000p+38},
       0},
      {{0x1.7137a502bc000p+40, -2.0, 0x1.7137a502ba000p+39},
       {0x1.b203362c6a000p+40, -16.0, 0x1.b203362c5a000p+39},
       {0x1.495cd6ecc0000p+40, -8.0, 0x1.495cd6ecb8000p+39},
       {-0x1.bbe8fc8880000p+40, 16.0, -0x1.bbe8fc886fff8p+39},
       -1},
  };
  return all;
}

TEST(Orient3d, HasItsConvention) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 7, 0}), 0);
}

TEST(Orient3d, AgreesWithRationalArithmetic) {
  for (std::size_t i = 0; i < cases().size(); ++i) {
    const Case& k = cases()[i];
    EXPECT_EQ(orient3d(k.a, k.b, k.c, k.d), k.sign) << i;
  }
}

TEST(Orient3d, SwappingTwoPointsReversesTheSign) {
  for (std::size_t i = 0; i < cases().size(); ++i) {
    const Case& k = cases()[i];
    const std::array<Vec3d, 4> points{k.a, k.b, k.c, k.d};
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    do {
      int parity = 1;
      for (std::size_t x = 0; x < 4; ++x) {
        for (std::size_t y = x + 1; y < 4; ++y) parity *= order[x] < order[y] ? 1 : -1;
      }
      EXPECT_EQ(orient3d(points[order[0]], points[order[1]], points[order[2]], points[order[3]]), parity * k.sign) << i;
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Orient3d, AgreesWithWideIntegers) {
  __extension__ using Wide = __int128;
  Random random(7);
  std::array<int, 3> seen{};
  for (int run = 0; run < 20000; ++run) {
    // Points lie in a plane through the first, or a step beside it. Coordinates reach 2^35, products 2^112.
    const auto whole = [&](double size) { return std::floor(random.uniform(-size, size)); };
    const Vec3d a{whole(0x1p34), whole(0x1p34), whole(0x1p34)};
    const Vec3d u{whole(0x1p16), whole(0x1p16), whole(0x1p16)};
    const Vec3d v{whole(0x1p16), whole(0x1p16), whole(0x1p16)};
    Vec3d d = a + u * whole(0x1p15) + v * whole(0x1p15);
    d[random.below(3)] += std::floor(random.uniform(-1, 2));
    const Vec3d b = a + u * whole(0x1p15);
    const Vec3d c = a + v * whole(0x1p15);
    const auto wide = [](double x) { return static_cast<Wide>(x); };
    const Vec3d p = b - a;
    const Vec3d q = c - a;
    const Vec3d r = d - a;
    const Wide determinant = wide(p.x) * (wide(q.y) * wide(r.z) - wide(q.z) * wide(r.y)) +
                             wide(p.y) * (wide(q.z) * wide(r.x) - wide(q.x) * wide(r.z)) +
                             wide(p.z) * (wide(q.x) * wide(r.y) - wide(q.y) * wide(r.x));
    const int sign = determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
    ASSERT_EQ(orient3d(a, b, c, d), sign) << run;
    ++seen[static_cast<std::size_t>(sign + 1)];
  }
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 3000);
}

}  // namespace
}  // namespace blum::detail
